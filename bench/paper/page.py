"""The page that opens the paper's evaluation: promises, peers, differences, and where to look further."""

PEERS = [
    ("libigl", "`principal_curvature`: a quadric fitted over so many rings (5 is its own choice); k1² + k2²"),
    ("MeshLab", "through pymeshlab. Meshes: quadric fitting and Taubin's approximation as curvedness c (2 c²), and its other "
                "filter, the discrete mean and Gaussian curvature of Meyer et al. (4 H² − 2 K). Clouds: algebraic point set "
                "surfaces on 2,500 of the points. Decimation: quadric edge collapse that preserves normals"),
    ("Rusinkiewicz 2004", "our own reading, in trimesh2's place: per-face tensors averaged by Voronoi areas; squared norm"),
    ("PCL", "`NormalEstimation`, `PrincipalCurvaturesEstimation`, both with k: eigenvalues of the covariance of normals, no "
            "curvatures (not divided by the size of the neighbourhood). Rescaled to the truth as the paper did, and as they are"),
    ("meshoptimizer", "of npm. Decimation: `simplify`, and `simplifyWithUpdate`, which moves the vertices that are kept"),
    ("OpenMesh", "Debian's. Decimation: `ModQuadric`, `ModNormalFlipping`"),
    ("CGAL", "Debian's. Monge forms by jets of degree 2 to 4; the Voronoi covariance measure, density 4 (l1 + l2) / (l3 r²); "
             "decimation by Lindstrom–Turk and by Garland–Heckbert"),
    ("Open3D", "has no curvature: its PCA normals and spanning tree, and our fan on them, are the recipe of the author's second "
               "program. Decimation: quadrics"),
]

DIFFERENCES = """
- **What is compared.** The paper defines the integral over a triangle; its tables hold the density of a vertex against the exact
  value there, and so do these. With that reading its own column is met to four digits.
- **The other columns of the paper** are not printed here: they were not at hand when this was written, and a number that was not
  measured or read has no place. What is known of them: the libigl column is its default radius 5; radius 2 is far better (both
  are in the table). trimesh2's column measures an error in its 3 × 3 solver: the method itself, row *Rusinkiewicz 2004*, is
  three to ten times better. MeshLab's Taubin column does not come out of its library; MeshLab's *other* filter (*discrete*)
  is better than the paper on these regular grids, and falls apart on irregular ones.
- **Clouds.** The paper samples a mesh of the torus, we the torus itself: our errors with ground-truth normals are a little
  smaller. *Nonuniform* is a random half of 40,000 Poisson-disk points.
- **Best parameters** of a peer are chosen with the truth, cell by cell, which a user cannot do. Ours has no parameter.
- **DGtal.** The package on PyPI (2.2.0) measures curvatures of voxel surfaces and does not bind its corrected curvatures of
  triangle meshes, and Debian 12 has no DGtal: no row. `corrected` is our own implementation of that method.
- **Decimation.** The paper's table states neither the ratio nor the normalisation and cannot be reproduced from public material:
  the table tries its claim, weights against no weights in both pipelines, row by row.
"""


def peer_versions(tables):
    """{peer: versions} of the rows "NAME VERSION …"."""
    found = {}
    for table in tables:
        for row in table.rows:
            for name, _ in PEERS:
                words = row.removeprefix(name).split()
                if row.startswith(name) and words and words[0][0].isdigit():
                    found.setdefault(name, set()).add(words[0].rstrip(",:"))
    return found


def page(how, seconds, checks, sections, figures):
    lines = ["# The paper's evaluation, made anew", "",
             'Crane He Chen, "Estimating Discrete Total Curvature with Per Triangle Normal Variation", SIGGRAPH 2023 Talks.',
             f"Every number was measured by `{how}` in one run ({seconds / 60:.0f} minutes on two cores), but those of rows",
             "that begin with *the paper,*. A peer that is not installed has no row.", "",
             "| promise | measured | holds |", "|---|---|---|", *(check.markdown() for check in checks), "",
             "## Tables", ""]
    for name, tables in sections.items():
        titles = "; ".join(table.title for table in tables)
        lines.append(f"- [{titles}]({name}.md), [with parameters and seconds]({name}.csv)")
    versions = peer_versions([table for tables in sections.values() for table in tables])
    lines += ["", "## Peers", "", "| peer | version | what it measures |", "|---|---|---|"]
    lines += [f"| {name} | {', '.join(sorted(versions.get(name, [])))} | {what} |" for name, what in PEERS]
    lines += ["", "## How it differs from the paper", DIFFERENCES, "## Pictures", ""]
    for name, caption in figures.items():
        lines += [f"{caption}:", "", f"![{caption}]({name}.png)", ""]
    return "\n".join(lines)
