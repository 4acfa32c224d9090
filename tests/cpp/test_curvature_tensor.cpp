// The shape operator: signs, directions, convergence, invariances, and what derives from k1 and k2.
#include <algorithm>
#include <limits>
#include <numbers>

#include "clouds.h"
#include "gaussmap/curvature.h"
#include "gaussmap/surfaces.h"
#include "support.h"

using namespace gaussmap;

namespace {

using Array = std::vector<double>;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr SurfaceOptions uneven = {.jitter = 0.25, .noise = 0, .seed = 5};

MeshCurvature of_mesh(const Surface& s, const Array& normals, int threads = 0) {
    MeshCurvatureOptions options;
    options.tensor = true;
    options.run.threads = threads;
    return mesh_curvature(s.vertices, s.faces, normals, options);
}

PrincipalCurvatures of_vertices(const Surface& s, bool exact_normals = true) {
    return of_mesh(s, exact_normals ? s.normals : Array()).vertex_tensor;
}

PrincipalCurvatures of_cloud(const Array& points, const Array& normals, int threads = 0) {
    CloudCurvatureOptions options;
    options.estimator = Estimator::dirichlet;
    options.tensor = true;
    options.run.threads = threads;
    return cloud_curvature(points, normals, options).tensor;
}

/// The vertices of a surface, with its exact normals, as a mesh and as a cloud.
std::vector<PrincipalCurvatures> both(const Surface& s) {
    return {of_vertices(s), of_cloud(s.vertices, s.normals)};
}

double error(const PrincipalCurvatures& tensor, const Surface& s) {
    return support::rmse(tensor.k1, s.k1) + support::rmse(tensor.k2, s.k2);
}

Array density(const PrincipalCurvatures& tensor) {
    Array out(tensor.k1.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = tensor.k1[i] * tensor.k1[i] + tensor.k2[i] * tensor.k2[i];
    return out;
}

Array negative(Array values) {
    for (double& v : values) v = -v;
    return values;
}

Array scaled(Array values, double factor) {
    for (double& v : values) v *= factor;
    return values;
}

/// sin of the angle between direction i and a vector that is not zero.
double sine(const PrincipalCurvatures& tensor, std::size_t i, std::array<double, 3> along) {
    const double* d = &tensor.direction[3 * i];
    const double c = support::dot3(d, along.data());
    return std::sqrt(std::max(0.0, 1 - c * c / support::dot3(along.data(), along.data())));
}

double largest_difference(const Array& a, const Array& b) {
    double worst = a.size() == b.size() ? 0 : INFINITY;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
    return worst;
}

bool same_bits(const PrincipalCurvatures& a, const PrincipalCurvatures& b) {
    return support::same_bits(a.k1, b.k1) && support::same_bits(a.k2, b.k2) &&
           support::same_bits(a.direction, b.direction);
}

}  // namespace

TEST(Tensor, IsEmptyUnlessAskedFor) {
    const Surface s = sphere(2);
    const MeshCurvature mesh = mesh_curvature(s.vertices, s.faces);
    EXPECT_TRUE(mesh.vertex_tensor.k1.empty() && mesh.face_tensor.k1.empty() && mesh.vertex_tensor.direction.empty());
    EXPECT_TRUE(mesh.error.empty() && mesh.choice.empty());
    for (const Estimator estimator : {Estimator::automatic, Estimator::dirichlet}) {
        CloudCurvatureOptions options;
        options.estimator = estimator;
        const CloudCurvature cloud = cloud_curvature(s.vertices, {}, options);
        EXPECT_TRUE(cloud.tensor.k1.empty() && cloud.tensor.direction.empty() && cloud.error.empty());
    }
    EXPECT_TRUE(support::same_bits(of_mesh(s, {}).density, mesh.density));
}

TEST(Tensor, SphereAndCylinderAreExact) {
    for (const double radius : {1e-3, 1.0, 250.0}) {
        const Surface round = sphere(3, radius, uneven);
        for (const PrincipalCurvatures& tensor : both(round))
            for (const Array& k : {tensor.k1, tensor.k2})
                for (const double v : k) ASSERT_NEAR(v * radius, 1, 1e-12);
        const MeshCurvature estimated = of_mesh(round, {});
        for (const Array& k : {estimated.vertex_tensor.k1, estimated.face_tensor.k2})
            for (const double v : k) ASSERT_NEAR(v * radius, 1, 1e-9);

        const Surface tube = cylinder(radius, 3 * radius, 40, 20);
        for (const PrincipalCurvatures& tensor : both(tube))
            for (std::size_t i = 0; i < tensor.k1.size(); ++i) {
                ASSERT_NEAR(tensor.k1[i] * radius, 1, 1e-12);
                ASSERT_NEAR(tensor.k2[i] * radius, 0, 1e-12);
            }
    }
}

TEST(Tensor, CylinderBendsAroundItsAxisWhateverTheTriangles) {
    const Surface tube = cylinder(0.8, 3, 40, 20, uneven);
    for (const PrincipalCurvatures& tensor : both(tube))
        for (std::size_t i = 0; i < tensor.k1.size(); ++i) {
            ASSERT_NEAR(tensor.k1[i] * 0.8, 1, 0.005);
            ASSERT_NEAR(tensor.k2[i] * 0.8, 0, 0.005);
            ASSERT_LT(sine(tensor, i, {-tube.vertices[3 * i + 1], tube.vertices[3 * i], 0}), 0.01);
        }
}

TEST(Tensor, PlaneIsExactlyZero) {
    const Surface s = plane(3, 2, 20, 30, uneven);
    const MeshCurvature mesh = of_mesh(s, {});
    for (const PrincipalCurvatures& tensor : {mesh.vertex_tensor, mesh.face_tensor, of_cloud(s.vertices, s.normals)}) {
        for (const double k : tensor.k1) ASSERT_EQ(k, 0);
        for (const double k : tensor.k2) ASSERT_EQ(k, 0);
        for (std::size_t i = 0; i < tensor.k1.size(); ++i) {
            ASSERT_EQ(tensor.direction[3 * i + 2], 0) << "in the plane";
            ASSERT_NEAR(support::dot3(&tensor.direction[3 * i], &tensor.direction[3 * i]), 1, 1e-15);
        }
    }
}

TEST(Tensor, SignsAreThoseOfTheSurface) {
    // A torus has saddles inside, a catenoid nothing else: k1 = −k2.
    const Surface ring = torus(1, 0.5, 72, 48, uneven);
    for (const PrincipalCurvatures& tensor : both(ring))
        for (std::size_t i = 0; i < tensor.k1.size(); ++i) {
            ASSERT_GE(tensor.k1[i], tensor.k2[i]);
            ASSERT_NEAR(tensor.k1[i], ring.k1[i], 0.3);
            ASSERT_NEAR(tensor.k2[i], ring.k2[i], 0.3);
        }
    const Surface neck = catenoid(0.7, 2, 80, 40);
    for (const PrincipalCurvatures& tensor : both(neck))
        for (std::size_t i = 0; i < tensor.k1.size(); ++i) {
            ASSERT_GT(tensor.k1[i], 0);
            ASSERT_LT(tensor.k2[i], 0);
            const double mean = mean_curvature(tensor.k1[i], tensor.k2[i]);
            ASSERT_LT(std::abs(mean), 0.1 * curvedness(neck.k1[i], neck.k2[i]));
            ASSERT_NEAR(shape_index(tensor.k1[i], tensor.k2[i]), 0, 0.07);
        }
}

TEST(Tensor, DirectionsOfTorusAndCatenoid) {
    // k1 runs around the tube of the torus, in the plane of the axis; around the axis on the catenoid.
    const Surface ring = torus(1, 0.5, 72, 48, uneven);
    for (const PrincipalCurvatures& tensor : both(ring))
        for (std::size_t i = 0; i < tensor.k1.size(); ++i) {
            const double *p = &ring.vertices[3 * i], *n = &ring.normals[3 * i], r = std::hypot(p[0], p[1]);
            const double out = (n[0] * p[0] + n[1] * p[1]) / r;
            ASSERT_LT(sine(tensor, i, {-n[2] * p[0] / r, -n[2] * p[1] / r, out}), 0.1);
            ASSERT_NEAR(support::dot3(&tensor.direction[3 * i], n), 0, 1e-14);
            ASSERT_GE(tensor.direction[3 * i + 2], 0) << "looking up";
        }
    const Surface neck = catenoid(0.7, 2, 80, 40, uneven);
    for (const PrincipalCurvatures& tensor : both(neck))
        for (std::size_t i = 0; i < tensor.k1.size(); ++i)
            ASSERT_LT(sine(tensor, i, {-neck.vertices[3 * i + 1], neck.vertices[3 * i], 0}), 0.1);
}

TEST(Tensor, ConvergesQuadraticallyOnRegularGrids) {
    const auto rate = [](const auto& make) {
        const Surface coarse = make(40), fine = make(160);
        return std::log(error(of_vertices(coarse), coarse) / error(of_vertices(fine), fine)) / std::log(4.0);
    };
    EXPECT_GT(rate([](int n) { return torus(1, 0.4, n, 3 * n / 5); }), 1.9);
    EXPECT_GT(rate([](int n) { return catenoid(0.7, 2, n, n / 2); }), 1.6) << "its borders are of the first order";
    EXPECT_GT(rate([](int n) { return waves(3, 2, 0.3, 1.5, n, n); }), 1.7);
}

TEST(Tensor, FiguresOfTheDocumentation) {
    constexpr SurfaceOptions jittered = {.jitter = 0.25, .noise = 0, .seed = 1};
    struct Row {
        Surface surface;
        double k1, k2, squares, density;
    };
    for (const Row& row : {Row{torus(1, 0.5, 18, 18), 0.0265, 0.0472, 0.188, 0.143},
                           Row{torus(1, 0.5, 36, 36), 0.0067, 0.0120, 0.0486, 0.0372},
                           Row{torus(1, 0.5, 72, 72), 0.0017, 0.0030, 0.0122, 0.0094},
                           Row{ellipsoid(1, 0.8, 0.6, 3, jittered), 0.0375, 0.0167, 0.172, 0.170},
                           Row{ellipsoid(1, 0.8, 0.6, 5, jittered), 0.0091, 0.0040, 0.0407, 0.0407}}) {
        const Surface& s = row.surface;
        const MeshCurvature mesh = of_mesh(s, s.normals);
        EXPECT_NEAR(support::rmse(mesh.vertex_tensor.k1, s.k1), row.k1, 0.00005);
        EXPECT_NEAR(support::rmse(mesh.vertex_tensor.k2, s.k2), row.k2, 0.00005);
        EXPECT_NEAR(support::rmse(density(mesh.vertex_tensor), s.density), row.squares, 0.0005);
        EXPECT_NEAR(support::rmse(mesh.density, s.density), row.density, 0.0005);
    }
}

TEST(Tensor, ConvergesOnIrregularMeshesAndClouds) {
    double last = INFINITY, last_cloud = INFINITY;
    for (const int level : {3, 4, 5}) {
        const Surface s = ellipsoid(1, 0.8, 0.6, level, uneven);
        const std::vector<PrincipalCurvatures> tensors = both(s);
        EXPECT_LT(error(tensors[0], s), 0.6 * last) << level;
        EXPECT_LT(error(tensors[1], s), 0.6 * last_cloud) << level;
        last = error(tensors[0], s), last_cloud = error(tensors[1], s);
    }
}

TEST(Tensor, AgreesWithTheDensityWithinItsError) {
    for (const Surface& s : {torus(1, 0.5, 36, 36), ellipsoid(1, 0.8, 0.6, 4, uneven), catenoid(0.7, 2, 80, 40),
                             waves(3, 2, 0.3, 1.5, 60, 60)}) {
        for (const bool exact : {true, false}) {
            const MeshCurvature mesh = of_mesh(s, exact ? s.normals : Array());
            const double own = support::rmse(mesh.density, s.density);
            EXPECT_LT(support::rmse(density(mesh.vertex_tensor), s.density), 1.4 * own);
            EXPECT_LT(support::rmse(density(mesh.vertex_tensor), mesh.density), 2 * own);
            // Of a face the tensor leaves out what twists the normals, and what leaves its plane.
            const Array of_faces = density(mesh.face_tensor);
            for (std::size_t f = 0; f < mesh.kappa.size(); ++f)
                ASSERT_LE(of_faces[f], mesh.face_density[f] * (1 + 1e-9));
        }
    }
}

TEST(Tensor, FlippedNormalsTurnSignsAndNothingElse) {
    const Surface s = bumpy_sphere(1, 0.2, 3, 4, uneven);
    const Array turned = negative(s.normals);
    const auto check = [&](const PrincipalCurvatures& there, const PrincipalCurvatures& back, const Array& normals) {
        EXPECT_TRUE(support::same_bits(negative(there.k1), back.k2));
        EXPECT_TRUE(support::same_bits(negative(there.k2), back.k1));
        for (std::size_t i = 0; i < there.k1.size(); ++i) {
            const double *a = &there.direction[3 * i], *b = &back.direction[3 * i];
            ASSERT_NEAR(support::dot3(a, b), 0, 1e-14) << "the direction of k1 was that of k2";
            ASSERT_NEAR(normals.empty() ? 0 : support::dot3(b, &normals[3 * i]), 0, 1e-14);
        }
    };
    const MeshCurvature there = of_mesh(s, s.normals), back = of_mesh(s, turned);
    check(there.vertex_tensor, back.vertex_tensor, s.normals);
    check(there.face_tensor, back.face_tensor, {});
    check(of_cloud(s.vertices, s.normals), of_cloud(s.vertices, turned), s.normals);
}

TEST(Tensor, WindingIsImmaterialWithGivenNormals) {
    Surface s = bumpy_sphere(1, 0.2, 3, 4, uneven);
    const MeshCurvature right = of_mesh(s, s.normals);
    for (std::size_t f = 0; f < s.faces.size(); f += 6) std::swap(s.faces[f + 1], s.faces[f + 2]);
    const MeshCurvature mixed = of_mesh(s, s.normals);
    EXPECT_LT(largest_difference(mixed.vertex_tensor.k1, right.vertex_tensor.k1), 1e-11);
    EXPECT_LT(largest_difference(mixed.vertex_tensor.k2, right.vertex_tensor.k2), 1e-11);
    EXPECT_LT(largest_difference(mixed.face_tensor.k1, right.face_tensor.k1), 1e-11);
}

TEST(Tensor, MovesWithTheSurface) {
    support::Random random(3);
    const Surface s = bumpy_sphere(1, 0.2, 3, 4, uneven);
    const Array rotation = support::random_rotation(random);
    Surface moved = s;
    moved.vertices = support::times(rotation, s.vertices);
    moved.normals = support::times(rotation, s.normals);
    for (std::size_t i = 0; i < moved.vertices.size(); ++i) moved.vertices[i] = 4 * moved.vertices[i] + (i % 3) * 8.0;
    const std::vector<PrincipalCurvatures> here = both(s), there = both(moved);
    for (const int kind : {0, 1}) {
        EXPECT_LT(largest_difference(scaled(there[kind].k1, 4), here[kind].k1), 1e-10);
        EXPECT_LT(largest_difference(scaled(there[kind].k2, 4), here[kind].k2), 1e-10);
        const Array turned = support::times(rotation, here[kind].direction);
        for (std::size_t i = 0; i < s.k1.size(); ++i) {
            if (here[kind].k1[i] - here[kind].k2[i] < 1e-3) continue;  // an umbilic has any
            ASSERT_LT(sine(there[kind], i, {turned[3 * i], turned[3 * i + 1], turned[3 * i + 2]}), 1e-6);
        }
    }
    // Powers of two scale exactly.
    Surface larger = s;
    larger.vertices = scaled(s.vertices, 0x1p20);
    for (const int kind : {0, 1})
        EXPECT_TRUE(support::same_bits(scaled(both(larger)[kind].k2, 0x1p20), here[kind].k2)) << kind;
}

TEST(Tensor, UndefinedIsNaN) {
    Surface s = torus(1, 0.5, 24, 16);
    const MeshCurvature whole = of_mesh(s, s.normals);
    s.vertices[3 * 5] = not_a_number;
    for (int c = 0; c < 3; ++c) s.normals[3 * 200 + c] = 0;
    for (const double x : {9.0, 9.0, 9.0}) s.vertices.push_back(x), s.normals.push_back(1);  // of no face
    s.faces.insert(s.faces.end(), {50, 50, 51});                                             // of no area
    const MeshCurvature mesh = of_mesh(s, s.normals);
    for (const std::size_t v : {std::size_t{5}, std::size_t{200}, s.vertices.size() / 3 - 1}) {
        EXPECT_TRUE(std::isnan(mesh.vertex_tensor.k1[v]) && std::isnan(mesh.vertex_tensor.k2[v]));
        EXPECT_TRUE(std::isnan(mesh.vertex_tensor.direction[3 * v + 2]));
    }
    for (std::size_t v = 0; v < mesh.density.size(); ++v)
        ASSERT_EQ(std::isnan(mesh.vertex_tensor.k1[v]), std::isnan(mesh.density[v])) << v;
    for (std::size_t f = 0; f < mesh.kappa.size(); ++f)
        ASSERT_EQ(std::isnan(mesh.face_tensor.k1[f]), std::isnan(mesh.face_density[f])) << f;
    EXPECT_TRUE(support::same_bits({mesh.vertex_tensor.k1[50]}, {whole.vertex_tensor.k1[50]}));

    const PrincipalCurvatures cloud = of_cloud(s.vertices, s.normals);
    for (const std::size_t v : {std::size_t{5}, std::size_t{200}})
        EXPECT_TRUE(std::isnan(cloud.k1[v]) && std::isnan(cloud.k2[v]) && std::isnan(cloud.direction[3 * v]));
}

TEST(Tensor, CopiesOfAPointShareItsResult) {
    const support::Cloud sphere = support::sphere_cloud(2, 500, 4);
    Array points = sphere.points, normals = sphere.normals;
    for (int c = 0; c < 3; ++c) points.push_back(points[30 + c]), normals.push_back(1);
    const PrincipalCurvatures tensor = of_cloud(points, normals);
    EXPECT_EQ(tensor.k1.back(), tensor.k1[10]);
    EXPECT_EQ(tensor.k2.back(), tensor.k2[10]);
    EXPECT_EQ(tensor.direction.back(), tensor.direction[32]);
    EXPECT_NEAR(tensor.k1[10], 0.5, 1e-12);
}

TEST(Tensor, EstimatedNormalsOfACloudGiveSignsOncePropagated) {
    const support::Cloud torus = support::torus_cloud(1, 0.5, 0.05, 8);
    CloudCurvatureOptions options;
    options.estimator = Estimator::dirichlet;
    options.tensor = true;
    options.orientation = Orientation::mst;
    const PrincipalCurvatures signs = cloud_curvature(torus.points, {}, options).tensor;
    for (const double k1 : signs.k1) ASSERT_NEAR(k1, 2, 0.4) << "outward everywhere, as the highest point looks up";
    options.orientation = Orientation::local;
    const PrincipalCurvatures own = cloud_curvature(torus.points, {}, options).tensor;
    for (std::size_t i = 0; i < own.k1.size(); ++i)
        ASSERT_NEAR(std::max(std::abs(own.k1[i]), std::abs(own.k2[i])), 2, 0.4) << "either sign";
}

TEST(Tensor, SameForAnyNumberOfThreads) {
    const Surface s = torus(1, 0.5, 200, 120, uneven);
    const MeshCurvature one = of_mesh(s, {}, 1);
    const PrincipalCurvatures cloud = of_cloud(s.vertices, {}, 1);
    for (const int threads : {2, 7}) {
        const MeshCurvature more = of_mesh(s, {}, threads);
        EXPECT_TRUE(same_bits(one.vertex_tensor, more.vertex_tensor));
        EXPECT_TRUE(same_bits(one.face_tensor, more.face_tensor));
        EXPECT_TRUE(same_bits(cloud, of_cloud(s.vertices, {}, threads)));
    }
}

TEST(Tensor, ReportsProgressAndCanBeCancelled) {
    const Surface s = torus(1, 0.5, 300, 200);
    MeshCurvatureOptions options;
    options.tensor = true;
    options.run.threads = 1;
    double last = 0;
    options.run.progress = [&](double done) {
        EXPECT_GE(done, last);
        last = done;
        return true;
    };
    mesh_curvature(s.vertices, s.faces, {}, options);
    EXPECT_DOUBLE_EQ(last, 1);
    for (const double when : {0.6, 0.8, 0.95}) {
        options.run.progress = [&](double done) { return done < when; };
        EXPECT_THROW(mesh_curvature(s.vertices, s.faces, {}, options), Cancelled) << when;
    }
}

TEST(Tensor, WhatDerivesFromTheTwo) {
    EXPECT_EQ(mean_curvature(3, -1), 1);
    EXPECT_EQ(gaussian_curvature(3, -1), -3);
    EXPECT_DOUBLE_EQ(curvedness(3, -1), std::sqrt(5.0));
    EXPECT_EQ(curvedness(2, 2), 2);
    EXPECT_DOUBLE_EQ(shape_index(2, 2), 1) << "a cap";
    EXPECT_DOUBLE_EQ(shape_index(2, 0), 0.5) << "a ridge";
    EXPECT_EQ(shape_index(2, -2), 0) << "a saddle";
    EXPECT_DOUBLE_EQ(shape_index(0, -2), -0.5) << "a rut";
    EXPECT_DOUBLE_EQ(shape_index(-2, -2), -1) << "a cup";
    EXPECT_TRUE(std::isnan(shape_index(0, 0))) << "flat";
    for (const auto function : {mean_curvature, gaussian_curvature, curvedness, shape_index})
        EXPECT_TRUE(std::isnan(function(not_a_number, not_a_number)));
}

TEST(Estimators, HaveNamesAndSayWhatTheyLack) {
    EXPECT_STREQ(estimator_name(Estimator::automatic), "auto");
    EXPECT_STREQ(estimator_name(Estimator::corrected), "corrected");
    EXPECT_STREQ(choice_name(0), "none");
    EXPECT_STREQ(choice_name(1), "quadric 9");
    EXPECT_STREQ(choice_name(2), "quartic 24");
    EXPECT_STREQ(choice_name(3), "corrected");
    EXPECT_STREQ(choice_name(16), "quadric 24");
    EXPECT_STREQ(choice_name(17), "half mean quadric 24");
    EXPECT_STREQ(choice_name(18), "mean quadric 24");
    EXPECT_STREQ(choice_name(19), "half slope 24");
    EXPECT_STREQ(choice_name(20), "slope 24");
    EXPECT_STREQ(choice_name(21), "quartic free 24");
    EXPECT_STREQ(choice_name(22), "sphere 24");
    EXPECT_STREQ(choice_name(23), "fine sphere 24");
    EXPECT_STREQ(choice_name(24), "extrapolated sphere 24");
    EXPECT_STREQ(choice_name(27), "mean quadric 35");
    EXPECT_STREQ(choice_name(39), "quartic free 50");
    EXPECT_STREQ(choice_name(43), "quadric 72");
    EXPECT_STREQ(choice_name(147), "quartic free 4050");
    EXPECT_EQ(support::refusal([] { choice_name(4); }), "choice = 4 is never written");
    EXPECT_EQ(support::refusal([] { choice_name(255); }), "choice = 255 is never written");
    const Surface s = sphere(1);
    MeshCurvatureOptions mesh;
    mesh.confidence = true;
    EXPECT_EQ(support::refusal([&] { mesh_curvature(s.vertices, s.faces, {}, mesh); }),
              "estimator = dirichlet has no confidence: nothing is fitted");
    CloudCurvatureOptions cloud;
    cloud.estimator = Estimator::corrected;
    EXPECT_EQ(support::refusal([&] { cloud_curvature(s.vertices, {}, cloud); }),
              "estimator = corrected is for meshes; a cloud has no faces");
}
