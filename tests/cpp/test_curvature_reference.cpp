// An independent slow reference: the cotangent matrix S assembled in long double, energy trace(N S Nᵀ), for every mesh
// of the folder of real files; and the numbers that the author's own program printed.
#include <algorithm>
#include <fstream>

#include "gaussmap/curvature.h"
#include "gaussmap/io.h"
#include "support.h"

using namespace gaussmap;

namespace {

using Real = long double;

struct Reference {
    Real energy = 0;                  // trace(N S Nᵀ) of the whole mesh
    std::vector<Real> vertex_energy;  // of the faces at each vertex
    std::vector<Real> vertex_area;
};

struct Triplet {
    std::int32_t row, column;
    Real value;
};

Real cotangent(const double* apex, const double* p, const double* q) {
    Real u[3], v[3], dot = 0;
    for (int c = 0; c < 3; ++c) u[c] = Real(p[c]) - apex[c], v[c] = Real(q[c]) - apex[c], dot += u[c] * v[c];
    const Real x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
    return dot / std::sqrt(x * x + y * y + z * z);
}

/// S has −cot/2 off the diagonal for each face and opposite corner, and rows that sum to zero. It is held as triplets
/// and multiplied out. Of the faces for which the library gives a kappa and an area.
Reference reference(const Geometry& g, const std::vector<double>& normals, const MeshCurvature& result) {
    const std::size_t n = g.vertex_count();
    std::vector<Triplet> s;
    s.reserve(12 * g.face_count());
    Reference r{0, std::vector<Real>(n), std::vector<Real>(n)};
    for (std::size_t f = 0; f < g.face_count(); ++f) {
        if (!std::isfinite(result.face_density[f])) continue;
        Real face_energy = 0, sum_cot_length = 0;
        for (int c = 0; c < 3; ++c) {
            const std::int32_t k = g.faces[3 * f + c], i = g.faces[3 * f + (c + 1) % 3],
                               j = g.faces[3 * f + (c + 2) % 3];
            const double *pi = &g.vertices[3 * i], *pj = &g.vertices[3 * j], *pk = &g.vertices[3 * k];
            const Real cot = cotangent(pk, pi, pj);
            s.insert(s.end(), {{i, j, -cot / 2}, {j, i, -cot / 2}, {i, i, cot / 2}, {j, j, cot / 2}});
            Real change = 0, length = 0;
            for (int d = 0; d < 3; ++d) {
                change +=
                    (Real(normals[3 * i + d]) - normals[3 * j + d]) * (Real(normals[3 * i + d]) - normals[3 * j + d]);
                length += (Real(pi[d]) - pj[d]) * (Real(pi[d]) - pj[d]);
            }
            face_energy += cot / 2 * change;
            sum_cot_length += cot * length;
        }
        for (int c = 0; c < 3; ++c) {
            r.vertex_energy[g.faces[3 * f + c]] += face_energy;
            r.vertex_area[g.faces[3 * f + c]] += sum_cot_length / 8 * 2;  // Σ cot |e|² = 4 A
        }
    }
    for (const auto& [i, j, value] : s)
        for (int d = 0; d < 3; ++d) r.energy += value * normals[3 * i + d] * normals[3 * j + d];
    return r;
}

std::vector<std::filesystem::path> mesh_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(support::data_folder() / "meshes"))
        if (format_of(entry.path().string()) != Format::detect && format_of(entry.path().string()) != Format::xyz &&
            (!support::sanitized || entry.file_size() < 500'000))
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<double> numbers(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::vector<double> values;
    for (double v; in >> v;) values.push_back(v);
    return values;
}

}  // namespace

TEST(MeshCurvatureReference, AgreesOnEveryRealMesh) {
    NEED_DATA();
    int meshes = 0;
    for (const auto& file : mesh_files()) {
        const Geometry g = read(file.string());
        if (g.faces.empty()) continue;
        ++meshes;
        const MeshCurvature result = mesh_curvature(g.vertices, g.faces);
        const Reference r = reference(g, result.normals, result);
        EXPECT_NEAR(result.kappa_sum / static_cast<double>(r.energy), 1, 1e-12) << file;
        Real mean = 0, area = 0;
        for (std::size_t v = 0; v < g.vertex_count(); ++v) mean += r.vertex_energy[v], area += r.vertex_area[v];
        mean /= area;
        for (std::size_t v = 0; v < g.vertex_count(); ++v) {
            if (std::isnan(result.density[v])) continue;
            const Real expected = r.vertex_energy[v] / r.vertex_area[v];
            ASSERT_NEAR(result.density[v], static_cast<double>(expected), 1e-12 * static_cast<double>(expected + mean))
                << file << " vertex " << v;
        }
    }
    EXPECT_GE(meshes, support::sanitized ? 25 : 40);
}

TEST(MeshCurvatureReference, AgreesWithTheAuthorsProgram) {
    NEED_DATA();
    MeshCurvatureOptions options;
    options.weights = NormalWeights::area;
    const std::pair<const char*, const char*> pairs[] = {{"cow.ply", "cow_mesh.txt"},
                                                         {"icosahedron_subdivide_6.ply", "sphere_mesh.txt"}};
    for (const auto& [mesh, printed] : pairs) {
        const Geometry g = read((support::data_folder() / "meshes/seed" / mesh).string());
        const auto expected = numbers(support::data_folder() / "meshes/seed" / printed);
        const auto result = mesh_curvature(g.vertices, g.faces, {}, options);
        ASSERT_EQ(expected.size(), result.density.size());
        std::vector<double> errors;
        for (std::size_t v = 0; v < expected.size(); ++v)
            errors.push_back(std::abs(result.density[v] / expected[v] - 1));
        std::sort(errors.begin(), errors.end());
        EXPECT_LT(errors.back(), 5e-6) << mesh << ", of numbers printed with six digits; median"
                                       << errors[errors.size() / 2];
    }
}
