// Small meshes whose every count is known by hand, then real files against counts made elsewhere.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "gaussmap/inspect.h"
#include "gaussmap/surfaces.h"
#include "support.h"

namespace {

using gaussmap::inspect;
using gaussmap::Inspection;

struct Mesh {
    std::vector<double> vertices;
    std::vector<std::int32_t> faces;
};

const Mesh cube{
    {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1},
    {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7}};

/// Both meshes in one, the second moved by (x, y, z).
Mesh joined(Mesh a, const Mesh& b, double x, double y, double z) {
    const auto offset = static_cast<std::int32_t>(a.vertices.size() / 3);
    for (std::size_t i = 0; i < b.vertices.size(); i += 3)
        a.vertices.insert(a.vertices.end(), {b.vertices[i] + x, b.vertices[i + 1] + y, b.vertices[i + 2] + z});
    for (const std::int32_t v : b.faces) a.faces.push_back(v + offset);
    return a;
}

/// Vertices at one position become the first of them.
Mesh welded(Mesh mesh) {
    for (std::int32_t& v : mesh.faces)
        for (std::int32_t u = 0; u < v; ++u)
            if (std::equal(&mesh.vertices[3 * u], &mesh.vertices[3 * u] + 3, &mesh.vertices[3 * v])) v = u;
    return mesh;
}

Inspection look(const Mesh& mesh) {
    return inspect(mesh.vertices, mesh.faces);
}

/// All that can be wrong with a mesh, so that a test states the one thing that is.
std::vector<std::size_t> faults(const Inspection& i) {
    return {
        i.non_finite,     i.duplicate_vertices, i.isolated_vertices,  i.degenerate_faces,      i.duplicate_faces,
        i.boundary_edges, i.boundary_loops,     i.non_manifold_edges, i.non_manifold_vertices, i.inconsistent_edges};
}

TEST(Cube, HasNoFaults) {
    const Inspection found = look(cube);
    EXPECT_EQ(found.vertices, 8u);
    EXPECT_EQ(found.faces, 12u);
    EXPECT_EQ(found.edges, 18u);
    EXPECT_EQ(found.components, 1u);
    EXPECT_EQ(faults(found), (std::vector<std::size_t>(10, 0)));
    EXPECT_DOUBLE_EQ(found.area, 6);
    EXPECT_DOUBLE_EQ(found.diagonal, std::sqrt(3));
    EXPECT_DOUBLE_EQ(found.mean_edge, (12 + 6 * std::sqrt(2)) / 18);
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(found.minimum[c], 0);
        EXPECT_EQ(found.maximum[c], 1);
    }
}

TEST(OpenQuad, HasOneLoopOfFourEdges) {
    const Inspection found = look({{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {0, 1, 2, 0, 2, 3}});
    EXPECT_EQ(faults(found), (std::vector<std::size_t>{0, 0, 0, 0, 0, 4, 1, 0, 0, 0}));
    EXPECT_EQ(found.edges, 5u);
    EXPECT_EQ(found.components, 1u);
}

TEST(Cylinder, HasTwoLoops) {
    const gaussmap::Surface cylinder = gaussmap::cylinder(1, 1, 12, 4);
    const Inspection found = inspect(cylinder.vertices, cylinder.faces);
    EXPECT_EQ(faults(found), (std::vector<std::size_t>{0, 0, 0, 0, 0, 24, 2, 0, 0, 0}));
}

TEST(FanOfThreeOnAnEdge, IsANonManifoldEdgeButNoNonManifoldVertex) {
    const Inspection found = look({{0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, -1, 0, 0}, {0, 1, 2, 0, 1, 3, 0, 1, 4}});
    EXPECT_EQ(faults(found), (std::vector<std::size_t>{0, 0, 0, 0, 0, 6, 1, 1, 0, 0}));
    EXPECT_EQ(found.components, 1u);
}

TEST(TwoCubes, SharingAnEdge) {
    const Inspection apart = look(joined(cube, cube, 1, 1, 0));
    EXPECT_EQ(faults(apart), (std::vector<std::size_t>{0, 2, 0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(apart.components, 2u);
    const Inspection together = look(welded(joined(cube, cube, 1, 1, 0)));
    EXPECT_EQ(together.non_manifold_edges, 1u);
    EXPECT_EQ(together.non_manifold_vertices, 0u);
    EXPECT_EQ(together.components, 1u);
    EXPECT_EQ(together.isolated_vertices, 2u);
}

TEST(TwoCubes, SharingAVertex) {
    const Inspection found = look(welded(joined(cube, cube, 1, 1, 1)));
    EXPECT_EQ(faults(found), (std::vector<std::size_t>{0, 1, 1, 0, 0, 0, 0, 0, 1, 0}));
    EXPECT_EQ(found.components, 2u);  // a vertex does not connect
}

TEST(BowTie, IsANonManifoldVertexOnOneLoop) {
    const Inspection found = look({{0, 0, 0, 1, 1, 0, 1, -1, 0, -1, 1, 0, -1, -1, 0}, {0, 2, 1, 0, 3, 4}});
    EXPECT_EQ(faults(found), (std::vector<std::size_t>{0, 0, 0, 0, 0, 6, 1, 0, 1, 0}));
    EXPECT_EQ(found.components, 2u);
}

TEST(MoebiusStrip, HasOneLoopAndOneInconsistentEdge) {
    // Twelve cells around, half a turn: the last cell joins the first one upside down.
    Mesh strip;
    const int n = 12;
    for (int i = 0; i < n; ++i)
        for (const double s : {-0.3, 0.3}) {
            const double u = 2 * std::numbers::pi * i / n;
            strip.vertices.insert(strip.vertices.end(), {(1 + s * std::cos(u / 2)) * std::cos(u),
                                                         (1 + s * std::cos(u / 2)) * std::sin(u), s * std::sin(u / 2)});
        }
    for (int i = 0; i < n; ++i) {
        const bool last = i == n - 1;
        const int a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
        strip.faces.insert(strip.faces.end(), {a, c, b, b, c, d});
    }
    const Inspection found = look(strip);
    EXPECT_EQ(faults(found), (std::vector<std::size_t>{0, 0, 0, 0, 0, 24, 1, 0, 0, 1}));
    EXPECT_EQ(found.components, 1u);
    EXPECT_EQ(static_cast<int>(found.vertices + found.faces) - static_cast<int>(found.edges), 0);
}

TEST(Flipped, FaceOfACubeIsThreeInconsistentEdges) {
    Mesh mesh = cube;
    std::swap(mesh.faces[0], mesh.faces[1]);
    EXPECT_EQ(faults(look(mesh)), (std::vector<std::size_t>{0, 0, 0, 0, 0, 0, 0, 0, 0, 3}));
}

TEST(DuplicateFaces, AreFoundInAnyOrderAndTurn) {
    Mesh mesh = cube;
    mesh.faces.insert(mesh.faces.end(), {2, 1, 0, 2, 0, 1});  // the first face, again and turned over
    const Inspection found = look(mesh);
    EXPECT_EQ(found.duplicate_faces, 2u);
    EXPECT_EQ(found.non_manifold_edges, 3u);
}

TEST(DegenerateFaces, RepeatedIndexCountsAndHasNoEdges) {
    const Inspection found = look({{0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5}, {0, 1, 2, 3, 3, 0, 1, 1, 1}});
    EXPECT_EQ(found.degenerate_faces, 2u);
    EXPECT_EQ(found.edges, 3u);
    EXPECT_EQ(found.components, 1u);
    EXPECT_EQ(found.isolated_vertices, 0u);
    EXPECT_EQ(found.non_manifold_vertices, 0u);
    EXPECT_DOUBLE_EQ(found.area, 0.5);
}

TEST(DegenerateFaces, AreMeasuredRelativeToTheirSize) {
    // Collinear by construction at any scale and away from any axis; a sliver of 1e-9 of its length is a triangle.
    for (const double scale : {1e-30, 1.0, 1e30}) {
        const double s = scale;
        const Inspection flat = look({{0, 0, 0, s, 2 * s, 3 * s, 3 * s, 6 * s, 9 * s}, {0, 1, 2}});
        EXPECT_EQ(flat.degenerate_faces, 1u) << scale;
        EXPECT_EQ(flat.area, 0) << scale;
        EXPECT_EQ(flat.edges, 3u) << scale;
        EXPECT_EQ(look({{0, 0, 0, s, 0, 0, s / 2, 1e-9 * s, 0}, {0, 1, 2}}).degenerate_faces, 0u) << scale;
    }
    EXPECT_EQ(look({{1, 2, 3, 1, 2, 3, 1, 2, 3}, {0, 1, 2}}).degenerate_faces, 1u);
}

TEST(NonFinite, VerticesAreCountedAndLeftOut) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    const Inspection found =
        look({{0, 0, 0, 1, 0, 0, 0, 1, 0, nan, 0, 0, 0, infinity, 0, nan, 0, 0}, {0, 1, 2, 0, 1, 3, 1, 4, 2, 3, 4, 5}});
    EXPECT_EQ(found.non_finite, 3u);
    EXPECT_EQ(found.duplicate_vertices, 0u);
    EXPECT_EQ(found.degenerate_faces, 0u);
    EXPECT_DOUBLE_EQ(found.area, 0.5);
    EXPECT_DOUBLE_EQ(found.mean_edge, (2 + std::sqrt(2)) / 3);
    EXPECT_DOUBLE_EQ(found.diagonal, std::sqrt(2));
    EXPECT_EQ(found.edges, 10u);
}

TEST(NonFinite, Everywhere) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Inspection found = look({std::vector<double>(9, nan), {0, 1, 2}});
    EXPECT_EQ(found.non_finite, 3u);
    EXPECT_EQ(found.minimum[0], 0);
    EXPECT_EQ(found.maximum[2], 0);
    EXPECT_EQ(found.diagonal, 0);
    EXPECT_EQ(found.mean_edge, 0);
    EXPECT_EQ(found.area, 0);
}

TEST(Cloud, HasNoCountsOfFaces) {
    const std::vector<double> points{1, 2, 3, 1, 2, 3, -1, 0.0, 0, -1, -0.0, 0};
    const Inspection found = inspect(points);
    EXPECT_EQ(found.vertices, 4u);
    EXPECT_EQ(found.duplicate_vertices, 2u);  // −0 is 0
    EXPECT_EQ(found.isolated_vertices, 0u);
    EXPECT_EQ(found.components, 0u);
    EXPECT_EQ(found.minimum[0], -1);
    EXPECT_EQ(found.maximum[2], 3);
}

TEST(Empty, IsAllZero) {
    const Inspection found = inspect({}, {});
    EXPECT_EQ(found.vertices, 0u);
    EXPECT_EQ(faults(found), (std::vector<std::size_t>(10, 0)));
    EXPECT_EQ(found.diagonal, 0);
}

TEST(IsolatedVertices, AreThoseOfNoFace) {
    Mesh mesh = cube;
    mesh.vertices.insert(mesh.vertices.end(), {9, 9, 9, 8, 8, 8});
    const Inspection found = look(mesh);
    EXPECT_EQ(faults(found), (std::vector<std::size_t>{0, 0, 2, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(found.maximum[0], 9);
}

TEST(Errors, NameTheFaceAndTheIndex) {
    for (const auto& [bad, text] : {std::pair<std::int32_t, std::string>{3, "faces[0][2] = 3 is outside [0, 3)"},
                                    {-1, "faces[0][2] = -1 is outside [0, 3)"}}) {
        try {
            look({std::vector<double>(9, 0.0), {0, 1, bad}});
            ADD_FAILURE() << "no error for " << bad;
        } catch (const std::invalid_argument& error) { EXPECT_EQ(error.what(), text); }
    }
}

/// The same counts, slowly: edges by comparing all pairs of sides, fans and parts by flooding.
struct Slow {
    std::size_t edges = 0, boundary = 0, non_manifold = 0, inconsistent = 0, components = 0, bad_vertices = 0;
};

std::size_t flooded(std::size_t count, const std::vector<std::pair<std::size_t, std::size_t>>& links,
                    const std::vector<bool>& in) {
    std::vector<std::size_t> label(count);
    std::iota(label.begin(), label.end(), 0);
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [a, b] : links)
            if (label[a] != label[b]) label[a] = label[b] = std::min(label[a], label[b]), changed = true;
    }
    std::size_t parts = 0;
    for (std::size_t i = 0; i < count; ++i) parts += in[i] && label[i] == i ? 1 : 0;
    return parts;
}

Slow slowly(std::size_t vertices, const std::vector<std::int32_t>& faces) {
    Slow slow;
    const std::size_t n = faces.size() / 3;
    std::vector<bool> whole(n), bad_edge(vertices);
    for (std::size_t f = 0; f < n; ++f)
        whole[f] = faces[3 * f] != faces[3 * f + 1] && faces[3 * f + 1] != faces[3 * f + 2] &&
                   faces[3 * f] != faces[3 * f + 2];
    std::vector<std::pair<std::size_t, std::size_t>> links;
    std::vector<std::vector<std::pair<std::size_t, std::size_t>>> links_at(vertices);
    for (int a = 0; a < static_cast<int>(vertices); ++a)
        for (int b = a + 1; b < static_cast<int>(vertices); ++b) {
            std::vector<std::size_t> on;
            int up = 0;
            for (std::size_t f = 0; f < n; ++f)
                for (int c = 0; whole[f] && c < 3; ++c) {
                    const int from = faces[3 * f + c], to = faces[3 * f + (c + 1) % 3];
                    if (std::min(from, to) == a && std::max(from, to) == b) on.push_back(f), up += from < to ? 1 : 0;
                }
            if (on.empty()) continue;
            ++slow.edges;
            slow.boundary += on.size() == 1 ? 1 : 0;
            slow.non_manifold += on.size() > 2 ? 1 : 0;
            slow.inconsistent += on.size() == 2 && up != 1 ? 1 : 0;
            if (on.size() > 2) bad_edge[a] = bad_edge[b] = true;
            for (std::size_t i = 1; i < on.size(); ++i)
                for (auto* list : {&links, &links_at[a], &links_at[b]}) list->emplace_back(on[i - 1], on[i]);
        }
    slow.components = flooded(n, links, whole);
    for (std::size_t v = 0; v < vertices; ++v) {
        std::vector<bool> here(n);
        for (std::size_t f = 0; f < n; ++f)
            for (int c = 0; c < 3; ++c) here[f] = here[f] || (whole[f] && faces[3 * f + c] == static_cast<int>(v));
        slow.bad_vertices += !bad_edge[v] && flooded(n, links_at[v], here) > 1 ? 1 : 0;
    }
    return slow;
}

TEST(RandomSoups, AgreeWithASlowCount) {
    support::Random random(5);
    for (int round = 0; round < 200; ++round) {
        const std::size_t vertices = 4 + random.below(9), faces = random.below(24);
        Mesh mesh;
        for (std::size_t i = 0; i < 3 * vertices; ++i) mesh.vertices.push_back(random.uniform());
        for (std::size_t i = 0; i < 3 * faces; ++i)
            mesh.faces.push_back(static_cast<std::int32_t>(random.below(vertices)));
        const Inspection found = look(mesh);
        const Slow slow = slowly(vertices, mesh.faces);
        ASSERT_EQ(found.edges, slow.edges) << round;
        ASSERT_EQ(found.boundary_edges, slow.boundary) << round;
        ASSERT_EQ(found.non_manifold_edges, slow.non_manifold) << round;
        ASSERT_EQ(found.inconsistent_edges, slow.inconsistent) << round;
        ASSERT_EQ(found.components, slow.components) << round;
        ASSERT_EQ(found.non_manifold_vertices, slow.bad_vertices) << round;
    }
}

}  // namespace
