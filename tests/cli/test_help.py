"""Help, version, and what is everywhere."""

import os
import re
import subprocess

import pytest

VERBS = ["curvature", "normals", "compare", "sample", "shape", "view", "convert", "info", "decimate"]
OPTIONS = {
    "curvature": "--as --normals --estimator --k --degree --orient --tensor --confidence --choice --truth "
    "--color --output --format --ascii",
    "normals": "--as --method --k --degree --orient --output --format --ascii",
    "compare": "--samples --bound --tolerance",
    "sample": "--count --method --output --format --ascii",
    "shape": "--subdivisions --radius --major --minor --grid --p --q --scale --axes --amplitude --frequency "
    "--wavelength --width --depth --height --jitter --noise --noise-unit --output --format --ascii",
    "view": "--field --as --range --size --views --from --up --output",
    "convert": "--weld --triangulate --output --format --ascii",
    "info": "",
    "decimate": "--faces --ratio --error --method --objective --weight --fast --preserve-boundary --lock-border "
    "--feature-angle --allow-topology --weld --output --format --ascii",
}


def test_no_arguments_shows_the_help_and_is_wrong_usage(gaussmap):
    run = gaussmap()
    assert run.code == 2 and run.stdout == b""
    assert run.stderr == gaussmap("--help").stdout.decode()


def test_help_opens_with_examples_and_names_every_verb(gaussmap):
    for word in ("--help", "-h"):
        run = gaussmap(word)
        assert run.code == 0 and run.stderr == ""
        page = run.stdout.decode()
        assert page.startswith("Examples:\n  gaussmap curvature")
        for verb in VERBS:
            assert re.search(rf"^  {verb} ", page, re.M)
        assert "1/length²" in page and "NaN" in page
        assert "Exit codes: 0 done, 1 failed while running, 2 wrong usage, 3 bad input." in page


@pytest.mark.parametrize("verb", VERBS)
def test_verb_help(gaussmap, verb):
    run = gaussmap(verb, "--help")
    assert run.code == 0 and run.stderr == ""
    page = run.stdout.decode()
    assert page.startswith(f"Examples:\n  gaussmap {verb} ") or page.startswith("Examples:\n  curl")
    assert f"\nUsage: gaussmap {verb} " in page
    for option in OPTIONS[verb].split() + ["--json", "--threads", "--quiet", "--seed", "--help", "--version"]:
        assert re.search(rf"^  (-\w, |    ){option}\b", page, re.M), option
    assert all(len(line) <= 80 for line in page.splitlines())
    assert page.endswith("\n") and not re.search(r" +$", page, re.M)


@pytest.mark.parametrize("verb", VERBS)
def test_help_wins_over_what_is_missing(gaussmap, verb):
    assert gaussmap(verb, "-h").stdout == gaussmap(verb, "--help", "--json").stdout


@pytest.mark.parametrize("verb", VERBS)
def test_every_option_of_the_examples_exists(gaussmap, verb):
    page = gaussmap(verb, "--help").stdout.decode()
    examples = page[: page.index("\n\nUsage:")]
    for option in re.findall(r"(--\w+)", examples):
        assert option in OPTIONS[verb].split() + ["--json", "--seed"]


def test_version(gaussmap):
    run = gaussmap("--version")
    assert run.code == 0 and re.fullmatch(rb"gaussmap \d+\.\d+\.\d+\n", run.stdout)
    assert gaussmap("info", "--version").stdout == run.stdout


@pytest.mark.parametrize("verb", VERBS)
def test_a_broken_pipe_is_no_crash(program, verb):
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run([program, verb, "--help"], stdout=writer, stderr=subprocess.PIPE, check=False)
    os.close(writer)
    assert done.returncode == 1
    assert done.stderr == b"gaussmap: standard output: Broken pipe\n"
