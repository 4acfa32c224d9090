// A depth buffer over four samples a pixel, in bands of rows. Triangles are tested with exact integer edge functions on
// a grid of 1/256 pixel (Pineda, "A Parallel Algorithm for Polygon Rasterization", SIGGRAPH 1988), edges included, so
// neighbours leave no gap. What is hidden behind an edge is darkened there, after Boucheny's eye-dome lighting (2009).
#include "rasterizer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "parallel.h"
#include "shading.h"

namespace gaussmap {
namespace {

constexpr int grid = 256;  // steps a pixel
constexpr int samples = 4;
// No two samples of a pixel share a row or a column: edges near the axes get four steps too.
constexpr int sample_x[samples] = {32, 96, 160, 224};
constexpr int sample_y[samples] = {160, 32, 224, 96};
constexpr int rows_a_band = 32;
constexpr std::size_t grain = 1 << 15;

/// A vertex on the picture; z is NaN where it is not drawn.
struct Corner {
    std::int32_t x = 0, y = 0;
    float z = std::numeric_limits<float>::quiet_NaN();
};

struct Sample {
    float z = -std::numeric_limits<float>::infinity();
    std::int32_t item = -1;
};

/// First and last row of pixels that a triangle or disc may touch; none where first > last.
struct Rows {
    std::int16_t first = 1, last = 0;
};

/// The samples of a band and of `margin` rows above and below it.
struct Band {
    int width, first, rows;  ///< rows that are kept, margins included
    std::vector<Sample> all;

    Band(int width_, int first_, int rows_)
        : width(width_), first(first_), rows(rows_), all(static_cast<std::size_t>(samples) * width_ * rows_) {}
    Sample* row(int s, int y) { return all.data() + (static_cast<std::size_t>(s) * rows + (y - first)) * width; }
    const Sample* row(int s, int y) const { return const_cast<Band*>(this)->row(s, y); }
};

int floor_pixel(std::int64_t v) {
    return static_cast<int>(v >> 8);
}

/// A triangle turned so that its area on the picture is positive.
struct Triangle {
    std::array<Corner, 3> c;
    std::array<int, 3> corner = {0, 1, 2};  ///< c[i] is this corner of the face
    std::int64_t area = 0;                  ///< twice, in steps²

    Triangle(const std::vector<Corner>& corners, const std::int32_t* face)
        : c{corners[face[0]], corners[face[1]], corners[face[2]]} {
        area = edge(0, c[2].x, c[2].y);
        if (area >= 0) return;
        std::swap(c[1], c[2]);
        std::swap(corner[1], corner[2]);
        area = -area;
    }
    /// Twice the area of (c[i], c[i+1], point): not negative for all i inside.
    std::int64_t edge(int i, std::int64_t x, std::int64_t y) const {
        const Corner &a = c[i], &b = c[(i + 1) % 3];
        return (std::int64_t{b.x} - a.x) * (y - a.y) - (std::int64_t{b.y} - a.y) * (x - a.x);
    }
};

void draw_triangle(const Triangle& t, std::int32_t item, Band& band) {
    if (t.area == 0) return;
    const auto [left, right] = std::minmax({t.c[0].x, t.c[1].x, t.c[2].x});
    const auto [top, bottom] = std::minmax({t.c[0].y, t.c[1].y, t.c[2].y});
    const double inverse = 1 / static_cast<double>(t.area);
    // Opposite edge i (from c[i] to c[i+1]) lies c[i+2].
    const double z0 = t.c[2].z, z1 = (t.c[0].z - z0) * inverse, z2 = (t.c[1].z - z0) * inverse;
    std::int64_t step_x[3], step_y[3];
    for (int i = 0; i < 3; ++i) {
        const Corner &a = t.c[i], &b = t.c[(i + 1) % 3];
        step_x[i] = (std::int64_t{a.y} - b.y) * grid;
        step_y[i] = (std::int64_t{b.x} - a.x) * grid;
    }
    for (int s = 0; s < samples; ++s) {
        // Pixels whose sample lies between the sides, rounded inward.
        const int x0 = std::max(0, floor_pixel(left - sample_x[s] + grid - 1));
        const int x1 = std::min(band.width - 1, floor_pixel(right - sample_x[s]));
        const int y0 = std::max(band.first, floor_pixel(top - sample_y[s] + grid - 1));
        const int y1 = std::min(band.first + band.rows - 1, floor_pixel(bottom - sample_y[s]));
        if (x0 > x1 || y0 > y1) continue;
        std::int64_t start[3];
        for (int i = 0; i < 3; ++i)
            start[i] = t.edge(i, std::int64_t{x0} * grid + sample_x[s], std::int64_t{y0} * grid + sample_y[s]);
        for (int y = y0; y <= y1; ++y) {
            std::int64_t e0 = start[0], e1 = start[1], e2 = start[2];
            Sample* row = band.row(s, y);
            for (int x = x0; x <= x1; ++x) {
                if ((e0 | e1 | e2) >= 0) {
                    const auto z = static_cast<float>(z0 + static_cast<double>(e1) * z1 + static_cast<double>(e2) * z2);
                    if (z > row[x].z) row[x] = {z, item};
                }
                e0 += step_x[0], e1 += step_x[1], e2 += step_x[2];
            }
            for (int i = 0; i < 3; ++i) start[i] += step_y[i];
        }
    }
}

/// A point's disc in pixels, turned along its normal.
struct Disc {
    double x, y, z, radius;
    Vec3 normal;
};

void draw_disc(const Disc& d, std::int32_t item, Band& band) {
    const double slope_x = -d.normal.x / d.normal.z, slope_y = -d.normal.y / d.normal.z;
    const double squared_radius = d.radius * d.radius;
    for (int s = 0; s < samples; ++s) {
        const double ox = sample_x[s] / double{grid} - d.x, oy = sample_y[s] / double{grid} - d.y;
        const int x0 = std::max(0, static_cast<int>(std::ceil(-d.radius - ox)));
        const int x1 = std::min(band.width - 1, static_cast<int>(std::floor(d.radius - ox)));
        const int y0 = std::max(band.first, static_cast<int>(std::ceil(-d.radius - oy)));
        const int y1 = std::min(band.first + band.rows - 1, static_cast<int>(std::floor(d.radius - oy)));
        for (int y = y0; y <= y1; ++y) {
            const double dy = y + oy;
            Sample* row = band.row(s, y);
            for (int x = x0; x <= x1; ++x) {
                const double dx = x + ox, dz = slope_x * dx + slope_y * dy;
                const double inside = 1 - (dx * dx + dy * dy + dz * dz) / squared_radius;
                if (inside < 0) continue;
                // Highest in the middle: discs of one surface meet halfway between their points.
                const auto z = static_cast<float>(d.z + dz + 0.5 * d.radius * inside);
                if (z > row[x].z) row[x] = {z, item};
            }
        }
    }
}

class Renderer {
  public:
    Renderer(const Scene& scene, const Ramp& ramp, const Projection& projection, const Viewport& viewport,
             Picture& picture)
        : scene_(scene),
          ramp_(ramp),
          projection_(projection),
          viewport_(viewport),
          picture_(picture),
          reach_(std::max(1, std::min(viewport.width, viewport.height) / 500)),
          corners_(scene.vertices.count),
          rows_(scene.faces.empty() ? scene.vertices.count : scene.faces.count) {}

    void prepare(const Execution& run) {
        for_blocks(corners_.size(), grain, run, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) project(v);
        });
        for_blocks(rows_.size(), grain, run, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) rows_[i] = scene_.faces.empty() ? disc_rows(i) : face_rows(i);
        });
    }

    void draw_rows(int begin, int end) const {
        const int first = std::max(0, begin - reach_), last = std::min(viewport_.height, end + reach_);
        Band band(viewport_.width, first, last - first);
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            if (rows_[i].first >= last || rows_[i].last < first) continue;
            const auto item = static_cast<std::int32_t>(i);
            if (scene_.faces.empty())
                draw_disc(disc(i), item, band);
            else
                draw_triangle(Triangle(corners_, scene_.faces[i]), item, band);
        }
        for (int y = begin; y < end; ++y) resolve(band, y);
    }

  private:
    void project(std::size_t v) {
        const Vec3 p = load(scene_.vertices[v]);
        if (!finite(p)) return;
        const Vec3 q = projection_(p);
        // A vertex of no face may lie far outside the picture.
        constexpr double most = 1e6;
        if (std::abs(q.x) > most || std::abs(q.y) > most) return;
        corners_[v] = {static_cast<std::int32_t>(std::lround(q.x * grid)),
                       static_cast<std::int32_t>(std::lround(q.y * grid)), static_cast<float>(q.z)};
    }

    Rows rows_between(double top, double bottom) const {
        const double end = viewport_.height;
        return {static_cast<std::int16_t>(std::clamp(std::floor(top), 0.0, end)),
                static_cast<std::int16_t>(std::clamp(std::floor(bottom), -1.0, end))};
    }

    Rows face_rows(std::size_t f) const {
        const std::int32_t* face = scene_.faces[f];
        const Corner &a = corners_[face[0]], &b = corners_[face[1]], &c = corners_[face[2]];
        if (std::isnan(a.z) || std::isnan(b.z) || std::isnan(c.z)) return {};
        const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
        return rows_between(top / double{grid}, bottom / double{grid});
    }

    Rows disc_rows(std::size_t i) const {
        if (std::isnan(corners_[i].z) || !(scene_.radii[i] > 0)) return {};
        const Disc d = disc(i);
        return rows_between(d.y - d.radius, d.y + d.radius);
    }

    Disc disc(std::size_t i) const {
        const Vec3 q = projection_(load(scene_.vertices[i]));
        // Smaller discs could fall between the samples; steeper ones would be needles.
        constexpr double least_radius = 0.7, least_z = 0.3;
        Vec3 n = scene_.normals.empty() ? Vec3{0, 0, 1} : facing_eye(projection_.turn(load(&scene_.normals[3 * i])));
        if (n.z < least_z) {
            const double flat = std::sqrt((1 - least_z * least_z) / (1 - n.z * n.z));
            n = {n.x * flat, n.y * flat, least_z};
        }
        return {q.x, q.y, q.z, std::max(least_radius, projection_.scale * scene_.radii[i]), n};
    }

    /// Either side of a surface is lit; without a normal it faces the eye.
    static Vec3 facing_eye(Vec3 n) {
        if (!finite(n)) return {0, 0, 1};
        return n.z < 0 ? -n : n;
    }

    const LinearRgb& color(double value) const { return std::isfinite(value) ? ramp_(value) : ramp_.undefined(); }

    LinearRgb shaded(const Band& band, int s, int x, int y) const {
        const Sample& sample = band.row(s, y)[x];
        const double open = openness(band, s, x, y);
        const auto i = static_cast<std::size_t>(sample.item);
        if (scene_.faces.empty()) {
            const Vec3 n = scene_.normals.empty() ? Vec3{0, 0, 1} : projection_.turn(load(&scene_.normals[3 * i]));
            return shade(color(scene_.values[i]), facing_eye(n), open);
        }
        const std::int32_t* face = scene_.faces[i];
        const Triangle t(corners_, face);
        std::array<double, 3> weight{};  // of the face's corners
        for (int k = 0; k < 3; ++k)
            weight[t.corner[k]] = static_cast<double>(t.edge((k + 1) % 3, std::int64_t{x} * grid + sample_x[s],
                                                             std::int64_t{y} * grid + sample_y[s])) /
                                  static_cast<double>(t.area);
        return shade(interpolated_color(face, weight), facing_eye(projection_.turn(normal(face, weight))), open);
    }

    /// Around an undefined corner, what is nearest to it is undefined.
    LinearRgb interpolated_color(const std::int32_t* face, const std::array<double, 3>& weight) const {
        double sum = 0, of = 0;
        int nearest = 0;
        for (int k = 0; k < 3; ++k) {
            if (weight[k] > weight[nearest]) nearest = k;
            const double value = scene_.values[face[k]];
            if (std::isfinite(value)) sum += weight[k] * value, of += weight[k];
        }
        return std::isfinite(scene_.values[face[nearest]]) ? ramp_(sum / of) : ramp_.undefined();
    }

    /// The vertex normals, interpolated; the face's own at corners where they differ by more than 37°: a crease.
    Vec3 normal(const std::int32_t* face, const std::array<double, 3>& weight) const {
        const Vec3 a = load(scene_.vertices[face[0]]);
        const Vec3 n = cross(load(scene_.vertices[face[1]]) - a, load(scene_.vertices[face[2]]) - a);
        const Vec3 flat = (1 / length(n)) * n;
        Vec3 sum;
        for (int k = 0; k < 3; ++k) {
            const Vec3 smooth = load(&scene_.normals[3 * static_cast<std::size_t>(face[k])]);
            const double agreement = dot(smooth, flat);  // either sign: given normals may point inward
            sum = sum + weight[k] * (std::abs(agreement) > 0.8 ? (agreement < 0 ? -smooth : smooth) : flat);
        }
        return (1 / length(sum)) * sum;
    }

    /// How little of the surroundings stands in front: 1 in the open.
    double openness(const Band& band, int s, int x, int y) const {
        const float z = band.row(s, y)[x].z;
        const double full = 0.03 * std::min(viewport_.width, viewport_.height);
        double covered = 0;
        for (int dy = -reach_; dy <= reach_; dy += reach_)
            for (int dx = -reach_; dx <= reach_; dx += reach_) {
                if (x + dx < 0 || x + dx >= band.width || y + dy < band.first || y + dy >= band.first + band.rows)
                    continue;
                covered += std::clamp((band.row(s, y + dy)[x + dx].z - z) / full, 0.0, 1.0);
            }
        return 1 - 0.6 * std::min(1.0, covered / 4);
    }

    void resolve(const Band& band, int y) const {
        std::uint8_t* out =
            picture_.rgb.data() + 3 * ((static_cast<std::size_t>(viewport_.y) + y) * picture_.width + viewport_.x);
        for (int x = 0; x < viewport_.width; ++x, out += 3) {
            float r = 0, g = 0, b = 0;
            bool touched = false;
            std::array<LinearRgb, samples> colors;
            for (int s = 0; s < samples; ++s) {
                const std::int32_t item = band.row(s, y)[x].item;
                // Samples of one pixel on one triangle look alike: one is shaded.
                int same = 0;
                while (same < s && band.row(same, y)[x].item != item) ++same;
                colors[s] = same < s ? colors[same] : item < 0 ? LinearRgb{1, 1, 1} : shaded(band, s, x, y);
                r += colors[s].r, g += colors[s].g, b += colors[s].b;
                touched |= item >= 0;
            }
            if (!touched) continue;
            out[0] = encoded_of(r / samples), out[1] = encoded_of(g / samples), out[2] = encoded_of(b / samples);
        }
    }

    const Scene& scene_;
    const Ramp& ramp_;
    const Projection& projection_;
    const Viewport& viewport_;
    Picture& picture_;
    int reach_;  ///< pixels to the surroundings that may stand in front
    std::vector<Corner> corners_;
    std::vector<Rows> rows_;
};

}  // namespace

void render(const Scene& scene, const Ramp& ramp, const Projection& projection, const Viewport& viewport,
            Picture& picture, const Execution& run) {
    Renderer renderer(scene, ramp, projection, viewport, picture);
    renderer.prepare({run.threads, {}});
    for_blocks(static_cast<std::size_t>(viewport.height), rows_a_band, run,
               [&](std::size_t, std::size_t begin, std::size_t end) {
                   renderer.draw_rows(static_cast<int>(begin), static_cast<int>(end));
               });
}

}  // namespace gaussmap
