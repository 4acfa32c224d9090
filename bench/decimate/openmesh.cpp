// openmesh IN.off OUT_PREFIX FACES…: OpenMesh's decimater, quadrics and its guard against flipped normals.
// Prints one line a result as peers.py does.
#include <OpenMesh/Core/System/config.h>
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include <chrono>
#include <cstdio>
#include <string>

namespace {
struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) return 2;
    Mesh whole;
    if (!OpenMesh::IO::read_mesh(whole, argv[1])) return 1;
    for (int i = 3; i < argc; ++i) {
        Mesh mesh = whole;
        mesh.request_face_normals();
        mesh.update_face_normals();
        const auto begin = std::chrono::steady_clock::now();
        OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
        OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
        OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
        decimater.add(quadric);
        decimater.add(flipping);
        decimater.module(quadric).unset_max_err();
        if (!decimater.initialize()) return 1;
        decimater.decimate_to_faces(0, std::stoul(argv[i]));
        mesh.garbage_collection();
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        const std::string path = std::string(argv[2]) + "openmesh_" + argv[i] + ".off";
        if (!OpenMesh::IO::write_mesh(mesh, path, OpenMesh::IO::Options::Default, 17)) return 1;
        std::printf("openmesh\t%d.%d\tModQuadric, ModNormalFlipping\t%s\t%zu\t%.4f\t%s\n", OM_VERSION >> 16,
                    OM_VERSION >> 8 & 0xff, argv[i], mesh.n_faces(), seconds, path.c_str());
        std::fflush(stdout);
    }
}
