// cgal METHOD IN.off OUT_PREFIX FACES…: edge collapse of CGAL, method lt (Lindstrom-Turk) or gh (Garland-Heckbert).
// Prints one line a result as peers.py does.
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>

#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/version.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>

namespace {

namespace sms = CGAL::Surface_mesh_simplification;
using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;

/// Stops at a number of faces: border edges make a number of edges no good for that.
struct AtFaces {
    std::size_t faces;
    template <class Profile>
    bool operator()(double, const Profile& profile, std::size_t, std::size_t) const {
        return profile.surface_mesh().number_of_faces() <= faces;
    }
};

}  // namespace

int main(int argc, char** argv) {
    if (argc < 5) return 2;
    const std::string method = argv[1];
    Mesh whole;
    std::ifstream in(argv[2]);
    if (!(in >> whole) || whole.number_of_faces() == 0) {
        std::fprintf(stderr, "cgal: %s is not a manifold mesh to it\n", argv[2]);
        return 1;
    }
    for (int i = 4; i < argc; ++i) {
        Mesh mesh = whole;
        const AtFaces stop{std::stoul(argv[i])};
        const auto begin = std::chrono::steady_clock::now();
        if (method == "gh") {
            const sms::GarlandHeckbert_plane_policies<Mesh, CGAL::Simple_cartesian<double>> policies(mesh);
            const sms::Bounded_normal_change_placement placement(policies.get_placement());
            sms::edge_collapse(mesh, stop, CGAL::parameters::get_cost(policies.get_cost()).get_placement(placement));
        } else {
            sms::edge_collapse(mesh, stop);
        }
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        mesh.collect_garbage();
        const std::string path = std::string(argv[3]) + "cgal-" + method + "_" + argv[i] + ".off";
        std::ofstream out(path);
        out.precision(17);
        out << mesh;
        std::printf("cgal-%s\t%s\tdefaults\t%s\t%zu\t%.4f\t%s\n", method.c_str(), CGAL_VERSION_STR, argv[i],
                    static_cast<std::size_t>(mesh.number_of_faces()), seconds, path.c_str());
        std::fflush(stdout);
    }
}
