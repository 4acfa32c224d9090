#include "lettering.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace gaussmap {
namespace {

/// A glyph is strokes parted by blanks; a stroke is points of two digits, x and y: capitals stand from y = 2 to 9,
/// small letters reach 7, descenders 0. '-' joins the points straight, '~' is a quadratic B-spline from the first to
/// the last, 'o' a closed one. A repeated point is a dot.
struct Glyph {
    char32_t code;
    const char* strokes;
};

constexpr Glyph glyphs[] = {
    {'0', "o02424909"},
    {'1', "-072922"},
    {'2', "~0709494602 -0242"},
    {'3', "~0709494626 ~2646420203"},
    {'4', "-32390444"},
    {'5', "-490906 ~0647420203"},
    {'6', "~490904 o02424606"},
    {'7', "-094912"},
    {'8', "o06464909 o02424606"},
    {'9', "o05454909 ~474202"},
    {'A', "-023962 -1454"},
    {'B', "-0902 ~092949462606 ~062646422202"},
    {'C', "~575909025254"},
    {'D', "-0902 ~092959522202"},
    {'E', "-49090242 -0636"},
    {'F', "-490902 -0636"},
    {'G', "~585909025255 -5535"},
    {'H', "-0209 -5259 -0656"},
    {'I', "-0209"},
    {'J', "-3934 ~34320203"},
    {'K', "-0209 -4905 -1642"},
    {'L', "-090242"},
    {'M', "-0209336962"},
    {'N', "-02095259"},
    {'O', "o02525909"},
    {'P', "-0209 ~092949452505"},
    {'Q', "o02525909 -3451"},
    {'R', "-0209 ~092949452505 -2542"},
    {'S', "~4849090645420203"},
    {'T', "-0949 -2922"},
    {'U', "-0905 ~05025255 -5559"},
    {'V', "-092249"},
    {'W', "-0922496289"},
    {'X', "-0249 -0942"},
    {'Y', "-092549 -2522"},
    {'Z', "-09490242"},
    {'a', "o02424707 -4742"},
    {'b', "-0902 o02424707"},
    {'c', "~464707024243"},
    {'d', "-4942 o02424707"},
    {'e', "-0545 ~454707024243"},
    {'f', "~391917 -1712 -0737"},
    {'g', "o02424707 -4742 ~42400001"},
    {'h', "-0902 ~05074745 -4542"},
    {'i', "-0207 -0909"},
    {'j', "-1712 ~121000 -1919"},
    {'k', "-0902 -4704 -1542"},
    {'l', "-0902"},
    {'m', "-0702 ~05073735 -3532 ~35376765 -6562"},
    {'n', "-0702 ~05074745 -4542"},
    {'o', "o02424707"},
    {'p', "-0700 o02424707"},
    {'q', "-4740 o02424707"},
    {'r', "-0702 ~040727"},
    {'s', "~3637070534320203"},
    {'t', "-1914 ~141232 -0737"},
    {'u', "-0704 ~04024244 -4742"},
    {'v', "-072247"},
    {'w', "-0712375267"},
    {'x', "-0247 -0742"},
    {'y', "-0722 -472210"},
    {'z', "-07470242"},
    {' ', ""},
    {'.', "-0202"},
    {',', "-1201"},
    {':', "-0202 -0606"},
    {';', "-1201 -1616"},
    {'-', "-0535"},
    {'+', "-0545 -2327"},
    {'=', "-0444 -0646"},
    {'/', "-0139"},
    {'\\', "-0931"},
    {'(', "~20030629"},
    {')', "~00232609"},
    {'[', "-29090020"},
    {']', "-09292000"},
    {'_', "-0141"},
    {'%', "o06262909 o42626545 -1259"},
    {'*', "-2529 -0648 -0846"},
    {'^', "-072947"},
    {'~', "~04163345"},
    {'<', "-470543"},
    {'>', "-074503"},
    {'|', "-0900"},
    {'!', "-0904 -0202"},
    {'?', "~080949462624 -2222"},
    {'"', "-0907 -2927"},
    {'\'', "-0907"},
    {'#', "-1229 -3249 -0454 -0757"},
    {U'²', "~0809292806 -0626"},
    {U'³', "~0809292818 ~1828260607"},
    {U'·', "-0505"},
    {U'−', "-0545"},
    {U'×', "-0346 -0643"},
};
constexpr const char* unknown = "-0242490902";

constexpr double steps_a_capital = 7, baseline = 2;
constexpr double between = 2.1, blank = 1.2;  // glyphs; a blank's own width
constexpr double pen = 0.13;                  // of a capital's height

struct Point {
    double x, y;
};

struct Segment {
    Point a, b;
};

double distance(Point p, const Segment& s) {
    const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y, squared = dx * dx + dy * dy;
    const double along = squared == 0 ? 0 : ((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / squared;
    const double t = std::clamp(along, 0.0, 1.0);
    return std::hypot(p.x - s.a.x - t * dx, p.y - s.a.y - t * dy);
}

Point middle(Point a, Point b) {
    return {(a.x + b.x) / 2, (a.y + b.y) / 2};
}

/// The parabola from a to b that leaves and arrives toward `control`, as straight pieces.
void add_parabola(std::vector<Segment>& out, Point a, Point control, Point b) {
    constexpr int pieces = 8;
    Point last = a;
    for (int i = 1; i <= pieces; ++i) {
        const double t = i / double{pieces}, u = 1 - t;
        const Point next = {u * u * a.x + 2 * u * t * control.x + t * t * b.x,
                            u * u * a.y + 2 * u * t * control.y + t * t * b.y};
        out.push_back({last, next});
        last = next;
    }
}

void add_stroke(std::vector<Segment>& out, char kind, const std::vector<Point>& p) {
    const std::size_t n = p.size();
    if (kind == '-') {
        for (std::size_t i = 0; i + 1 < n; ++i) out.push_back({p[i], p[i + 1]});
    } else if (kind == '~') {
        for (std::size_t i = 1; i + 1 < n; ++i)
            add_parabola(out, i == 1 ? p[0] : middle(p[i - 1], p[i]), p[i],
                         i + 2 == n ? p[n - 1] : middle(p[i], p[i + 1]));
    } else {
        for (std::size_t i = 0; i < n; ++i)
            add_parabola(out, middle(p[(i + n - 1) % n], p[i]), p[i], middle(p[i], p[(i + 1) % n]));
    }
}

/// In steps, y upward from the baseline.
struct Outline {
    std::vector<Segment> segments;
    double width = blank;
};

Outline outline_of(const char* strokes) {
    Outline out;
    if (*strokes != 0) out.width = 0;
    for (const char* at = strokes; *at != 0;) {
        const char kind = *at++;
        std::vector<Point> points;
        for (; *at != 0 && *at != ' '; at += 2) {
            points.push_back({double(at[0] - '0'), at[1] - '0' - baseline});
            out.width = std::max(out.width, points.back().x);
        }
        if (*at == ' ') ++at;
        add_stroke(out.segments, kind, points);
    }
    return out;
}

const Outline& outline(char32_t code) {
    static const auto table = [] {
        std::map<char32_t, Outline> t;
        for (const Glyph& glyph : glyphs) t[glyph.code] = outline_of(glyph.strokes);
        t[0] = outline_of(unknown);
        return t;
    }();
    const auto found = table.find(code);
    return found == table.end() ? table.at(0) : found->second;
}

/// Code points of UTF-8; a stray byte is one of no glyph.
std::vector<char32_t> code_points(std::string_view text) {
    std::vector<char32_t> out;
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = static_cast<unsigned char>(text[i++]);
        const int more = byte < 0xc0 ? 0 : byte < 0xe0 ? 1 : byte < 0xf0 ? 2 : 3;
        char32_t code = more == 0 ? byte : byte & (0x3f >> more);
        for (int k = 0; k < more && i < text.size() && (static_cast<unsigned char>(text[i]) & 0xc0) == 0x80; ++k)
            code = code << 6 | (static_cast<unsigned char>(text[i++]) & 0x3f);
        out.push_back(code >= 0x80 && more == 0 ? 0 : code);
    }
    return out;
}

/// Ink wherever a segment is within half the width, its edge softened over a pixel. Segments of one glyph come
/// together, so that ink is not laid twice where they meet.
void lay_ink(Picture& picture, const std::vector<Segment>& segments, double width, Ink ink) {
    double left = picture.width, right = 0, top = picture.height, bottom = 0;
    for (const Segment& s : segments)
        for (const Point& p : {s.a, s.b}) {
            left = std::min(left, p.x), right = std::max(right, p.x);
            top = std::min(top, p.y), bottom = std::max(bottom, p.y);
        }
    const double reach = width / 2 + 1;
    const int x0 = std::max(0, static_cast<int>(left - reach)), y0 = std::max(0, static_cast<int>(top - reach));
    const int x1 = std::min(picture.width - 1, static_cast<int>(right + reach));
    const int y1 = std::min(picture.height - 1, static_cast<int>(bottom + reach));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            double nearest = reach;
            for (const Segment& s : segments) nearest = std::min(nearest, distance({x + 0.5, y + 0.5}, s));
            const double cover = std::clamp(width / 2 + 0.5 - nearest, 0.0, 1.0);
            std::uint8_t* out = &picture.rgb[3 * (static_cast<std::size_t>(y) * picture.width + x)];
            for (int c = 0; c < 3; ++c)
                out[c] = static_cast<std::uint8_t>(std::lround(out[c] + cover * (ink[c] - out[c])));
        }
}

}  // namespace

double text_width(std::string_view text, double capital) {
    double steps = 0;
    for (const char32_t code : code_points(text)) steps += outline(code).width + between;
    return std::max(0.0, steps - between) * capital / steps_a_capital;
}

void write_text(Picture& picture, std::string_view text, double x, double y, double capital, Ink ink) {
    const double step = capital / steps_a_capital;
    for (const char32_t code : code_points(text)) {
        const Outline& glyph = outline(code);
        std::vector<Segment> placed;
        const auto place = [&](Point p) { return Point{x + step * p.x, y - step * p.y}; };
        for (const Segment& s : glyph.segments) placed.push_back({place(s.a), place(s.b)});
        lay_ink(picture, placed, pen * capital, ink);
        x += step * (glyph.width + between);
    }
}

void draw_line(Picture& picture, double x0, double y0, double x1, double y1, double width, Ink ink) {
    lay_ink(picture, {{{x0, y0}, {x1, y1}}}, width, ink);
}

}  // namespace gaussmap
