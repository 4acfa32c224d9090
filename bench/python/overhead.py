"""overhead.py BUILD MESH: what the package costs over the library on one mesh, in turns; and what importing costs.

The program call and this process measure the same call on the same mesh, one after the other, so that whatever else the
machine does falls on both."""

import statistics
import subprocess
import sys
import time

import gaussmap


def seconds_of(threads, build, mesh, geometry, rounds=101):
    child = subprocess.Popen(
        [f"{build}/bench/python_call", mesh, str(threads)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    ours, theirs = [], []
    for _ in range(rounds):
        child.stdin.write("\n")
        child.stdin.flush()
        seconds, kappa = child.stdout.readline().split()
        theirs.append(float(seconds))
        begin = time.perf_counter()
        result = gaussmap.curvature(geometry.vertices, geometry.faces, threads=threads)
        ours.append(time.perf_counter() - begin)
        assert result.kappa_sum == float(kappa), "not the same bits"
        del result
    child.stdin.close()
    child.wait()
    return ours, theirs


def importing(code):
    times = []
    for _ in range(9):
        begin = time.perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True)
        times.append(time.perf_counter() - begin)
    return min(times)


def main():
    build, mesh = sys.argv[1:3]
    geometry = gaussmap.read(mesh)
    print(
        f"{len(geometry.faces):,} triangles\n\n| threads | C++, ms | Python, ms | median ratio of a turn |\n|---|---|---|---|"
    )
    for threads in (1, 2):
        ours, theirs = seconds_of(threads, build, mesh, geometry)
        ratio = statistics.median(a / b for a, b in zip(ours, theirs, strict=True))
        print(f"| {threads} | {1e3 * min(theirs):.1f} | {1e3 * min(ours):.1f} | {ratio:.3f} |")
    nothing = importing("pass")
    print("\n| | s, beyond starting Python |\n|---|---|")
    print(f"| `import gaussmap` | {importing('import gaussmap') - nothing:.3f} |")
    print(f"| `import numpy` | {importing('import numpy') - nothing:.3f} |")
    print(
        f"| `import gaussmap; gaussmap.curvature` | {importing('import gaussmap; gaussmap.curvature') - nothing:.3f} |"
    )


if __name__ == "__main__":
    main()
