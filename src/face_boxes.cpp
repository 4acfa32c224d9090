#include "face_boxes.h"

#include <algorithm>

#include "parallel.h"
#include "triangle_closest.h"

namespace gaussmap {
namespace {

constexpr std::size_t run_of_faces = 4, children = 8;
constexpr float margin = 5e-7f;  ///< more than what coordinates within [−1, 1] and differences of them are rounded by
constexpr float infinite = std::numeric_limits<float>::infinity();

FaceBoxes::Node no_boxes() {
    FaceBoxes::Node node{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::fill_n(node.low[axis], children, infinite);
        std::fill_n(node.high[axis], children, -infinite);
    }
    return node;
}

void include(FaceBoxes::Node& node, std::size_t child, Vec3 p) {
    const float at[] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.low[axis][child] = std::min(node.low[axis][child], at[axis] - margin);
        node.high[axis][child] = std::max(node.high[axis][child], at[axis] + margin);
    }
}

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

class Search {
  public:
    Search(const FaceBoxes& boxes, Vec3 q, FaceHit start, double enough)
        : best(start),
          boxes_(boxes),
          q_(q),
          at_{static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)},
          enough_(enough) {}

    FaceHit best;

    /// From a face upwards: what is near is found before what is large.
    void climb(std::size_t face) {
        std::size_t done = face / run_of_faces;
        scan(done);
        for (std::size_t level = 0; level < boxes_.levels.size() && best.squared > enough_; ++level) {
            visit(level, done / children, done);
            done /= children;
        }
    }
    /// The children of a node but one.
    void visit(std::size_t level, std::size_t index, std::size_t but = none) {
        const FaceBoxes::Node& node = boxes_.levels[level][index];
        float gap[children] = {};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t c = 0; c < children; ++c) {
                const float below = node.low[axis][c] - at_[axis], above = at_[axis] - node.high[axis][c];
                const float aside = below > above ? below : above, apart = aside > 0 ? aside : 0;
                gap[c] += apart * apart;
            }
        std::size_t sorted[children], count = 0;
        for (std::size_t c = 0; c < children; ++c) {
            if (!worth(gap[c]) || index * children + c == but) continue;
            std::size_t at = count++;
            for (; at > 0 && gap[c] < gap[sorted[at - 1]]; --at) sorted[at] = sorted[at - 1];
            sorted[at] = c;
        }
        for (std::size_t i = 0; i < count && best.squared > enough_; ++i) {
            if (!worth(gap[sorted[i]])) return;
            const std::size_t child = index * children + sorted[i];
            if (level > 0)
                visit(level - 1, child);
            else
                scan(child);
        }
    }

  private:
    bool worth(float gap) const { return static_cast<double>(gap) * (1 - 1e-6) < best.squared; }
    void scan(std::size_t run) {
        const std::size_t end = std::min((run + 1) * run_of_faces, boxes_.corners.size() / 3);
        for (std::size_t f = run * run_of_faces; f < end && best.squared > enough_; ++f) {
            const FaceHit found = hit_of(boxes_, static_cast<std::int32_t>(f), q_);
            if (found.squared < best.squared) best = found;
        }
    }

    const FaceBoxes& boxes_;
    Vec3 q_;
    float at_[3];
    double enough_;
};

}  // namespace

FaceBoxes face_boxes(const std::vector<Vec3>& positions, const std::vector<std::int32_t>& corners,
                     const Execution& run) {
    FaceBoxes boxes{positions, corners, {}};
    const std::size_t faces = corners.size() / 3, in_node = run_of_faces * children;
    boxes.levels.emplace_back(block_count(faces, in_node), no_boxes());
    for_blocks(boxes.levels[0].size(), 512, {run.threads, {}}, [&](std::size_t, std::size_t node, std::size_t last) {
        for (; node < last; ++node)
            for (std::size_t c = 3 * node * in_node; c < std::min(3 * (node + 1) * in_node, 3 * faces); ++c)
                include(boxes.levels[0][node], c / (3 * run_of_faces) % children, positions[corners[c]]);
    });
    while (boxes.levels.back().size() > 1) {
        const std::vector<FaceBoxes::Node>& below = boxes.levels.back();
        std::vector<FaceBoxes::Node> level(block_count(below.size(), children), no_boxes());
        for (std::size_t i = 0; i < below.size(); ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                FaceBoxes::Node& node = level[i / children];
                node.low[axis][i % children] = *std::min_element(below[i].low[axis], below[i].low[axis] + children);
                node.high[axis][i % children] = *std::max_element(below[i].high[axis], below[i].high[axis] + children);
            }
        boxes.levels.push_back(std::move(level));
    }
    return boxes;
}

FaceHit hit_of(const FaceBoxes& boxes, std::int32_t face, Vec3 q) {
    if (face < 0) return {};
    const std::int32_t* v = &boxes.corners[3 * face];
    return {closest_on_triangle(q, boxes.positions[v[0]], boxes.positions[v[1]], boxes.positions[v[2]]).squared, face};
}

FaceHit closest_face(const FaceBoxes& boxes, Vec3 q, FaceHit start, double enough) {
    if (start.squared <= enough || boxes.corners.empty()) return start;
    Search search(boxes, q, start, enough);
    if (start.face >= 0)
        search.climb(static_cast<std::size_t>(start.face));
    else
        search.visit(boxes.levels.size() - 1, 0);
    return search.best;
}

}  // namespace gaussmap
