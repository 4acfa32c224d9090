// The page: a head in JSON that says what there is, and the arrays, each in blocks of packed_array.h.
#include "gaussmap/page.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "camera.h"
#include "check.h"
#include "disc_radii.h"
#include "drawn_box.h"
#include "json_text.h"
#include "octahedral.h"
#include "packed_array.h"
#include "parallel.h"
#include "percentile.h"
#include "viewer_page.h"

namespace gaussmap {
namespace {

/// What the fields are that gaussmap writes; `power` is that of 1/length.
struct Known {
    const char *name, *label;
    int power;
    bool diverging;
};
constexpr Known known_fields[] = {
    {"density", "total curvature k1² + k2²", 2, false},
    {"scalar_total_curvature", "total curvature k1² + k2²", 2, false},
    {"exact_density", "exact total curvature k1² + k2²", 2, false},
    {"density_error", "standard error of the total curvature", 2, false},
    {"k1", "k1, the greater principal curvature", 1, true},
    {"k2", "k2, the lesser principal curvature", 1, true},
    {"mean", "mean curvature (k1 + k2)/2", 1, true},
    {"gaussian", "Gaussian curvature k1 k2", 2, true},
    {"curvedness", "curvedness √((k1² + k2²)/2)", 1, false},
    {"shape_index", "shape index", 0, true},
    {"kappa", "total curvature of the face, integrated", 0, false},
};

bool all_float32(const double* values, std::size_t count) {
    return std::all_of(values, values + count,
                       [](double v) { return !std::isfinite(v) || static_cast<double>(static_cast<float>(v)) == v; });
}

void check(const std::vector<PageScene>& scenes, const PageOptions& options) {
    if (scenes.empty() || scenes.size() > 2)
        throw std::invalid_argument("page_html: " + std::to_string(scenes.size()) + " scenes; a page shows one or two");
    if (std::isinf(options.low) || std::isinf(options.high) || options.low >= options.high)
        throw std::invalid_argument("page_html: a range from low = " + shown(options.low) +
                                    " to high = " + shown(options.high) +
                                    "; low must be less than high, and both finite (or NaN: automatic)");
    bool found = options.field.empty();
    for (const PageScene& scene : scenes) {
        if (scene.vertices.empty()) throw std::invalid_argument("nothing to draw: there are no vertices");
        check_faces(scene.faces, scene.vertices.count);
        if (!scene.normals.empty()) check_count("normals", scene.normals.count, scene.vertices.count, "vertices");
        for (auto field = scene.fields.begin(); field != scene.fields.end(); ++field) {
            check_count(("field '" + field->name + "'").c_str(), field->values.size(),
                        field->of_faces ? scene.faces.count : scene.vertices.count,
                        field->of_faces ? "faces" : "vertices");
            if (std::any_of(scene.fields.begin(), field, [&](const PageField& other) {
                    return other.name == field->name && other.of_faces == field->of_faces;
                }))
                throw std::invalid_argument("page_html: two fields are called '" + field->name + "'");
            found = found || field->name == options.field;
        }
    }
    if (!found) throw std::invalid_argument("page_html: no scene has a field '" + options.field + "'");
}

/// The blocks of all arrays, in the order of the page.
class Blocks {
  public:
    explicit Blocks(int threads) : run_{threads, {}} {}

    /// {"block": the first, "rows": …, "columns": …, "type": …} of the array.
    template <class Word>
    std::string add(const std::vector<Word>& numbers, std::size_t columns, const char* type,
                    Differences differences = Differences::columns) {
        const std::size_t first = blocks_.size();
        for (std::string& block : packed(std::span<const Word>(numbers), columns, differences, run_))
            blocks_.push_back(std::move(block));
        return "{\"block\":" + std::to_string(first) + ",\"rows\":" + std::to_string(numbers.size() / columns) +
               ",\"columns\":" + std::to_string(columns) + ",\"type\":" + json_text(type) + "}";
    }

    /// As float32 where all fit, else as float64.
    std::string add_exactly(const std::vector<double>& values) {
        if (!all_float32(values.data(), values.size())) return add(words<std::uint64_t, double>(values), 1, "float64");
        return add(words<std::uint32_t, float>(values), 1, "float32");
    }

    template <class Word, class Float>
    static std::vector<Word> words(const std::vector<double>& values) {
        std::vector<Word> out(values.size());
        std::transform(values.begin(), values.end(), out.begin(), [](double v) {
            const auto stored = static_cast<Float>(v);
            // One NaN for all: its payload is no part of the value.
            return std::bit_cast<Word>(std::isfinite(stored) ? stored : std::numeric_limits<Float>::quiet_NaN());
        });
        return out;
    }

    const std::vector<std::string>& all() const { return blocks_; }

  private:
    Execution run_;
    std::vector<std::string> blocks_;
};

std::string number_triple(Vec3 v) {
    return json_list({json_number(v.x), json_number(v.y), json_number(v.z)});
}

/// "origin" and "positions".
std::string positions_of(const PageScene& scene, Vec3 centre, Blocks& blocks) {
    const std::size_t n = 3 * scene.vertices.count;
    std::vector<double> from_origin(scene.vertices.xyz, scene.vertices.xyz + n);
    Vec3 origin;
    if (!all_float32(from_origin.data(), n)) {
        origin = centre;
        for (std::size_t i = 0; i < n; i += 3) store(&from_origin[i], load(&from_origin[i]) - centre);
    }
    return "\"origin\":" + number_triple(origin) +
           ",\"positions\":" + blocks.add(Blocks::words<std::uint32_t, float>(from_origin), 3, "float32");
}

std::string normals_of(const PageScene& scene, Blocks& blocks) {
    if (scene.normals.empty()) return "null";
    std::vector<std::uint16_t> directions;
    directions.reserve(2 * scene.normals.count);
    for (std::size_t v = 0; v < scene.normals.count; ++v)
        for (const std::int16_t half : octahedral(load(scene.normals[v])))
            directions.push_back(static_cast<std::uint16_t>(half));
    return blocks.add(directions, 2, "octahedral");
}

std::string triangles_of(const PageScene& scene, Blocks& blocks) {
    if (scene.faces.empty()) return "null";
    const std::vector<std::uint32_t> corners(scene.faces.abc, scene.faces.abc + 3 * scene.faces.count);
    return blocks.add(corners, 3, "triangles", Differences::triangles);
}

std::string fields_of(const PageScene& scene, Blocks& blocks) {
    std::vector<std::string> out;
    out.reserve(scene.fields.size());
    for (const PageField& f : scene.fields)
        out.push_back("{\"name\":" + json_text(f.name) + ",\"label\":" + json_text(f.label.empty() ? f.name : f.label) +
                      ",\"unit\":" + json_text(f.unit) + ",\"of\":" + (f.of_faces ? "\"face\"" : "\"vertex\"") +
                      ",\"diverging\":" + (f.diverging ? "true" : "false") + ",\"noise\":" + json_number(f.noise) +
                      ",\"values\":" + blocks.add_exactly(f.values) + "}");
    return json_list(out);
}

/// The radius of most discs of a cloud; 0 for a mesh, or a single point.
double spacing_of(const PageScene& scene, const Box& box, int threads) {
    if (!scene.faces.empty() || box.diagonal() == 0) return 0;
    std::vector<double> radii = disc_radii(scene.vertices, {threads, {}});
    std::erase(radii, 0);
    return radii.empty() ? 0 : percentile(radii, 0.5);
}

std::string scene_head(const PageScene& scene, const PageOptions& options, Blocks& blocks) {
    const Box box = box_of(scene.vertices, scene.faces);
    PictureOptions view;
    view.direction = options.direction, view.up = options.up;
    const View axes = views_of(box.sides, view).front();
    return "{\"name\":" + json_text(scene.name) + ",\"toward\":" + number_triple(axes.toward) +
           ",\"up\":" + number_triple(axes.up) +
           ",\"spacing\":" + json_number(spacing_of(scene, box, options.run.threads)) + "," +
           positions_of(scene, box.centre, blocks) + ",\"triangles\":" + triangles_of(scene, blocks) +
           ",\"normals\":" + normals_of(scene, blocks) + ",\"fields\":" + fields_of(scene, blocks) + "}";
}

void report_progress(const Execution& run, double fraction) {
    if (run.progress && !run.progress(fraction)) throw Cancelled();
}

}  // namespace

void add_field(PageScene& scene, std::string name, std::vector<double> values, bool of_faces) {
    PageField field;
    field.values = std::move(values);
    field.of_faces = of_faces;
    const auto known =
        std::find_if(std::begin(known_fields), std::end(known_fields), [&](const Known& k) { return name == k.name; });
    if (known != std::end(known_fields)) {
        field.label = known->label;
        field.unit = known->power == 2 ? "1/unit²" : known->power == 1 ? "1/unit" : "";
        field.diverging = known->diverging;
        // 1e-9 / diagonal² for densities, as in picture.h; its square root for curvatures; for an integral over faces,
        // what such a density comes to on one of m faces that cover about diagonal².
        const double diagonal = box_of(scene.vertices, scene.faces).diagonal();
        if (diagonal > 0 && known->power > 0) field.noise = std::pow(std::sqrt(1e-9) / diagonal, known->power);
        if (name == "kappa" && of_faces && !scene.faces.empty())
            field.noise = 1e-9 / static_cast<double>(scene.faces.count);
    }
    field.name = std::move(name);
    scene.fields.push_back(std::move(field));
}

std::string page_obstacle() {
    if (viewer_page().empty())
        return "built without the viewer, which needs Node.js 18 or newer with npm; install them (Debian: nodejs npm), "
               "configure and build again";
    if (!can_pack()) return "built without zlib; install it (Debian: zlib1g-dev), configure and build again";
    return "";
}

std::string page_html(const std::vector<PageScene>& scenes, const PageOptions& options) {
    if (const std::string obstacle = page_obstacle(); !obstacle.empty())
        throw std::runtime_error("page_html: " + obstacle);
    check(scenes, options);
    Blocks blocks(options.run.threads);
    std::vector<std::string> heads;
    for (const PageScene& scene : scenes) {
        heads.push_back(scene_head(scene, options, blocks));
        report_progress(options.run, static_cast<double>(heads.size()) / static_cast<double>(scenes.size() + 1));
    }
    std::string data = "<script type=\"application/json\" id=\"gaussmap\">{\"format\":\"gaussmap page\",\"version\":1";
    data += ",\"title\":" + json_text(options.title) + ",\"field\":" + json_text(options.field) +
            ",\"low\":" + json_number(options.low) + ",\"high\":" + json_number(options.high) +
            ",\"rows_a_block\":" + std::to_string(packed_block) + ",\"blocks\":" + std::to_string(blocks.all().size()) +
            ",\"scenes\":" + json_list(heads) + "}</script>\n";
    std::size_t size = 0;
    for (const std::string& block : blocks.all()) size += block.size() + 80;

    const std::string_view viewer = viewer_page();
    const std::size_t mark = viewer.find(viewer_mark);
    if (mark == std::string_view::npos) throw std::runtime_error("page_html: the viewer has no place for data");
    std::string page;
    page.reserve(viewer.size() + data.size() + size);
    page.append(viewer.substr(0, mark)).append(data);
    for (std::size_t b = 0; b < blocks.all().size(); ++b)
        page.append("<script type=\"text/plain\" id=\"gaussmap-")
            .append(std::to_string(b))
            .append("\">")
            .append(blocks.all()[b])
            .append("</script>\n");
    page.append(viewer.substr(mark + viewer_mark.size()));
    report_progress(options.run, 1);
    return page;
}

}  // namespace gaussmap
