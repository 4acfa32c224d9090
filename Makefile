# The front door. On a fresh Debian 12: `make demo` shows what the program does, `make test` proves it.
#
#   make demo [IN=file]  install what is missing, build, measure a shape made on the spot (and IN)
#   make test            everything that is tested: C++, command line, install, layout; Release and sanitizers
#   make test-python     the Python package alone: wheel, clean environment, tests, types, documentation
#   make test-browser    the viewer and the page of make wasm in chromium (part of make test); screenshots in build/browser
#   make lint            formatting and static analysis
#   make bench           measurements against peers (not tests)
#   make bench-accuracy  accuracy against peers on analytic surfaces (hours; QUICK=1: one seed)
#   make bench-cloud     the parts of a program built like the author's against libigl's own
#   make bench-distance  closest points and distances against libigl, Open3D, MeshLab (IN="a.ply b.ply" adds yours)
#   make bench-decimate  decimation against ten peers, 8 meshes to 50 … 1 % (an hour)
#   make bench-python    the package against the library, and against peers in Python
#   make wasm            build/wasm/gaussmap.html: the page that measures in the browser
#   make bench-browser   that page against the program on one thread, and how soon the viewer shows a picture (IN="a.ply b.ply")
#   make bench-real      scans, outliers, sheets and edges: what the defaults say, into docs/real
#   make paper           the paper's tables and pictures, made anew beside its peers, into docs/paper (QUICK=1: 3 minutes)
#   make fuzz            feed the readers random files for FUZZ_SECONDS (default 60)
#   make clean           remove what was built

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
# Programs that run side by side would spin for each other's cores.
export OMP_WAIT_POLICY := passive
PYTEST := /usr/bin/python3 -m pytest -q -n 2 -p no:cacheprovider
FUZZ_SECONDS ?= 60
PROGRAM := build/release/gaussmap
PYTHON := build/python/bin/python
SOURCES = $(shell git ls-files '*.cpp' '*.h')

# Debian packages that are listed but not installed, nor there as a program of that name (npm of another source); sudo
# where we are not root.
packages = packages.txt
missing = $$(cat $(packages) | grep -v '^\#' | while read -r p; do dpkg -s "$$p" >/dev/null 2>&1 || command -v "$$p" >/dev/null || echo "$$p"; done)
sudo = $$([ "$$(id -u)" = 0 ] || echo sudo)

.PHONY: demo test test-release test-cli test-browser test-asan test-tsan test-python python-wheel python-stubs wasm bench-browser lint bench bench-accuracy bench-cloud bench-distance bench-decimate bench-python bench-real paper fuzz clean setup release

setup:
	@missing="$(missing)"; if [ -n "$$missing" ]; then echo "Installing" $$missing; \
	  $(sudo) apt-get update -qq; \
	  $(sudo) env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $$missing >/dev/null; fi

release: setup
	@cmake --preset release >/dev/null
	@cmake --build --preset release

demo: setup
	@cmake --preset release >/dev/null
	@cmake --build --preset release --target gaussmap_cli example_picture
	@mkdir -p out
	$(PROGRAM) shape bumpy --subdivisions 6 --jitter 0.2 -o out/bumpy.ply
	$(PROGRAM) curvature out/bumpy.ply --truth exact_density --color -o out/bumpy-curvature.ply -o out/bumpy-curvature.png -o out/bumpy-curvature.html
	build/release/examples/example_picture out/picture.png
	@if [ -n "$(IN)" ]; then name="out/$$(basename "$(IN)" | sed 's/\.[^.]*$$//')-curvature"; set -x; \
	  $(PROGRAM) curvature "$(IN)" --color -o "$$name.ply" -o "$$name.png" -o "$$name.html"; fi
	@echo; echo "Written (the HTML opens in any browser, the PLY in MeshLab and CloudCompare):"; ls -1 out/*-curvature.* out/picture.png | sed 's/^/  /'

test: test-release test-cli test-browser test-python test-asan test-tsan
	@echo; echo "All suites passed."

test-release: release
	ctest --preset release --no-tests=error -j 2

test-cli: release
	GAUSSMAP=$(PROGRAM) $(PYTEST) tests/cli

# The viewer is built with the program; node tells when no test ran.
test-browser: release wasm
	cd viewer && npm run --silent check
	@rm -rf build/browser; mkdir -p build/browser
	GAUSSMAP=$(PROGRAM) node --test tests/browser/ | tee build/browser/report.tap
	@grep -q '^# pass [1-9]' build/browser/report.tap || { echo "no browser test ran"; exit 1; }

test-asan: setup
	@cmake --preset asan >/dev/null
	@cmake --build --preset asan
	ctest --preset asan --no-tests=error -j 2
	GAUSSMAP=build/asan/gaussmap $(PYTEST) tests/cli

# Data races: the tests that run with several threads, told by their names.
test-tsan: setup
	@cmake --preset tsan >/dev/null
	@cmake --build --preset tsan
	ctest --preset tsan --no-tests=error -j 2 -R 'Threads|Parallel'

# The wheel, as `pip install .` makes it; its environment has what the tests need besides. The compiler is called as the
# other builds call it, so that ccache knows its work.
python-wheel: setup
	@[ -x $(PYTHON) ] || /usr/bin/python3 -m venv build/python
	@cmp -s tests/python/requirements.txt build/python/installed.txt || { $(PYTHON) -m pip install -q -r tests/python/requirements.txt && \
	  cp tests/python/requirements.txt build/python/installed.txt; }
	@rm -rf build/python/dist
	CXX=c++ $(PYTHON) -m pip wheel -q . --no-deps -w build/python/dist
	$(PYTHON) -m pip install -q --force-reinstall --no-deps build/python/dist/*.whl
	@rm -rf build/python/clean && $(PYTHON) -m venv build/python/clean && build/python/clean/bin/pip install -q build/python/dist/*.whl
	$(PYTHON) -m auditwheel show build/python/dist/*.whl
	cd build/python && clean/bin/python $(CURDIR)/tests/python/clean.py

test-python: release python-wheel
	GAUSSMAP=$(PROGRAM) $(PYTHON) -m pytest -q -n 2 -p no:cacheprovider -rs tests/python

python-stubs: python-wheel
	$(PYTHON) -m nanobind.stubgen -m gaussmap._gaussmap -o python/gaussmap/_gaussmap.pyi

wasm: setup
	@$(MAKE) --no-print-directory setup packages=wasm/packages.txt
	@cmake --preset wasm >/dev/null
	@cmake --build --preset wasm

bench-browser: release wasm
	GAUSSMAP=$(PROGRAM) node bench/browser/speed.mjs $(IN)
	GAUSSMAP=$(PROGRAM) node bench/browser/first_picture.mjs $(IN)

lint: setup
	clang-format-14 --dry-run --Werror $(SOURCES)
	@cmake --preset release >/dev/null
	run-clang-tidy-14 -quiet -p build/release '/(src|cli|examples)/' 2>/dev/null | sed '/clang-tidy-14 --use-color/d'

bench: setup
	@cmake --preset bench >/dev/null
	@cmake --build --preset bench
	build/bench/bench/mesh_curvature
	build/bench/bench/cloud_speed
	build/bench/bench/cloud_speed memory
	build/bench/bench/knn

bench-accuracy: packages = packages.txt bench/packages.txt
bench-accuracy: setup
	@cmake --preset bench >/dev/null
	@cmake --build --preset bench --target bench_accuracy
	/usr/bin/python3 bench/accuracy.py build/bench $(if $(QUICK),--quick)
	/usr/bin/python3 bench/mesh_speed.py build/bench

bench-cloud: setup
	@cmake --preset bench >/dev/null
	@cmake --build --preset bench --target bench_cloud_speed
	/usr/bin/python3 bench/cloud.py build/bench

bench-distance: packages = packages.txt bench/packages.txt
bench-distance: setup
	@cmake --preset bench >/dev/null
	@cmake --build --preset bench --target bench_closest gaussmap_cli
	/usr/bin/python3 bench/distance.py build/bench $(IN)

bench-decimate: packages = packages.txt bench/packages.txt
bench-decimate: setup
	@cmake --preset bench >/dev/null
	@cmake --build --preset bench --target bench_decimate
	/usr/bin/python3 bench/decimate.py build/bench $(IN)

bench-python: release python-wheel
	@cmake --preset bench >/dev/null
	@cmake --build --preset bench --target bench_python_call gaussmap_cli
	/usr/bin/python3 bench/python.py build/bench build/python/dist

bench-real: packages = packages.txt bench/packages.txt
bench-real: release
	/usr/bin/python3 bench/real build/release docs/real

paper: packages = packages.txt bench/packages.txt
paper: setup
	@cmake --preset bench >/dev/null
	@cmake --build --preset bench --target bench_accuracy bench_decimate
	/usr/bin/python3 bench/paper build/bench docs/paper $(if $(QUICK),--quick)

fuzz: setup
	@cmake --preset fuzz >/dev/null
	@cmake --build --preset fuzz
	@mkdir -p build/fuzz/corpus
	build/fuzz/tests/fuzz/fuzz_read -max_total_time=$(FUZZ_SECONDS) -rss_limit_mb=2048 -timeout=10 build/fuzz/corpus

clean:
	rm -rf build out
