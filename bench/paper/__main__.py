"""paper BUILD OUT [--quick]: the paper's evaluation, made anew beside the peers that are installed.

Writes tables (Markdown, CSV) and sheets of pictures (PNG) to the folder OUT, and its README.md: what was promised and what
was measured. --quick: fewer parameters of the peers, fewer irregular meshes, no bunny in the decimation.
"""

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(1, str(Path(__file__).resolve().parents[1]))

import clouds  # noqa: E402
import decimation  # noqa: E402
import figures  # noqa: E402
import meshes  # noqa: E402
import page  # noqa: E402
from runs import Runs  # noqa: E402
from table import write_csv  # noqa: E402


def write_tables(out, name, tables):
    """NAME.md and NAME.csv; the titles of what is in them."""
    (out / f"{name}.md").write_text("\n".join(["# " + tables[0].title.split(":")[0], "", "[The paper's evaluation](README.md)", ""]
                                              + [table.markdown() for table in tables]))
    write_csv(out / f"{name}.csv", tables)


def main():
    line = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    line.add_argument("build", type=Path)
    line.add_argument("out", type=Path)
    line.add_argument("--quick", action="store_true")
    options = line.parse_args()
    out = options.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    runs = Runs(options.build.resolve(), options.quick)  # installs the peers; not part of the time
    start = time.monotonic()

    def said(what):
        print(f"paper: {what}, {time.monotonic() - start:.0f} s", file=sys.stderr, flush=True)

    mesh_table, mesh_check = meshes.sphere_and_torus(runs)
    said("spheres and tori")
    irregular_table, irregular_check = meshes.irregular(runs)
    said("irregular meshes")
    cloud_tables, cloud_checks = clouds.tables(runs)
    said("clouds")
    decimation_tables, decimation_checks = decimation.tables(runs)
    said("decimation")
    sections = {"meshes": [mesh_table], "irregular-meshes": [irregular_table], "clouds": cloud_tables}
    sections |= {"decimation": decimation_tables} if decimation_tables else {}
    for name, tables in sections.items():
        write_tables(out, name, tables)
    sheets = figures.figures(runs, out)
    said("figures")
    checks = [mesh_check, irregular_check, *cloud_checks, *decimation_checks]
    how = "make paper" + (" QUICK=1" if options.quick else "")
    (out / "README.md").write_text(page.page(how, time.monotonic() - start, checks, sections, sheets))
    for check in checks:
        print(f"{'holds ' if check.holds else 'FAILS '} {check.promise}: {check.measured}")
    print(f"Written: {out}/README.md")


if __name__ == "__main__":
    main()
