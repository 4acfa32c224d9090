"""meshlab.py A B: MeshLab's Hausdorff filter both ways; RMS and maximum over A's diagonal.

What spot-checks our own `compare`."""

import sys

import pymeshlab


def main():
    meshes = pymeshlab.MeshSet()
    for path in sys.argv[1:3]:
        meshes.load_new_mesh(path)
    diagonal = meshes.mesh(0).bounding_box().diagonal()
    options = {"savesample": False, "samplenum": 200_000, "maxdist": pymeshlab.PercentageValue(100)}
    # Evenly on the faces for the RMS; vertices and edges too for the maximum.
    even = {"samplevert": False, "sampleedge": False, "sampleface": True}
    rms, most = 0, 0
    for a, b in ((0, 1), (1, 0)):
        way = {"sampledmesh": a, "targetmesh": b, **options}
        rms = max(rms, meshes.get_hausdorff_distance(**way, **even)["RMS"])
        most = max(most, meshes.get_hausdorff_distance(**way, samplevert=True, sampleedge=True, sampleface=True)["max"])
    print(rms / diagonal, most / diagonal)


main()
