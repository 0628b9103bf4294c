"""Compares foton with Mitsuba 3: `cargo xtask conformance [--quick]` makes the environment and runs this folder.

Every check renders one scene in both programs, from one and the same file, with several seeds of each. What is compared, and
how far the two may lie apart, stands in the check's module. Exits with 1 when a check fails.
"""

import argparse
import sys
import time
from dataclasses import replace
from pathlib import Path

import box_spheres
import depth_of_field
import depths
import diffuse_box
import path_tracing
import plugin_table
import plugins
import shared_scenes
from foton import Foton
from mitsuba_side import Mitsuba
from report import Report
from scenes import find_scenes


def main():
    """Runs the checks, prints the table, returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--foton", type=Path, required=True, help="the program to test")
    parser.add_argument("--repository", type=Path, required=True, help="where assets/ is")
    parser.add_argument("--out", type=Path, required=True, help="folder for pictures and cached references")
    parser.add_argument("--quick", action="store_true", help="only a diffuse box of assets/ and some plugins, small")
    parser.add_argument("--plugins", nargs="*", metavar="SCENE", help="only these scenes of plugins and formats, or all")
    parser.add_argument("--table", type=Path, help="with --plugins: where to write what was found, as a page of docs/")
    options = parser.parse_args()

    started = time.monotonic()
    options.out.mkdir(parents=True, exist_ok=True)
    foton = Foton(options.foton, options.out / "work")
    mitsuba = Mitsuba(options.out / "references", options.out / "work")
    report = Report()
    diffuse, benchmark = find_scenes(options.repository)

    print(f"{foton.version()} against Mitsuba {mitsuba.version} ({mitsuba.variant})", flush=True)
    if options.plugins is not None:
        effort = replace(plugins.FULL, names=tuple(options.plugins))
        findings = plugins.check(report, foton, mitsuba, options.repository, options.out, effort)
        if options.table:
            plugin_table.write(findings, (plugins.BOUND, plugins.FORMAT_BOUND), plugins.SIGMAS, plugins.PPM.share, options.table)
    elif options.quick:
        diffuse_box.check(report, foton, mitsuba, diffuse[0], options.out, diffuse_box.QUICK)
        path_tracing.check(report, foton, mitsuba, diffuse[0], path_tracing.QUICK)
        plugins.check(report, foton, mitsuba, options.repository, options.out, plugins.QUICK)
    else:
        for scene in diffuse:
            diffuse_box.check(report, foton, mitsuba, scene, options.out, diffuse_box.FULL)
            path_tracing.check(report, foton, mitsuba, scene, path_tracing.FULL)
        box_spheres.check(report, foton, mitsuba, benchmark, options.out)
        depth_of_field.check(report, foton, mitsuba, options.repository, options.out)
        depths.check(report, foton, mitsuba, [*diffuse, benchmark])
        plugins.check(report, foton, mitsuba, options.repository, options.out, plugins.FULL)
        shared_scenes.check(report, foton, mitsuba, shared_scenes.find_shared(options.repository), options.out)
    report.print_table()
    print(f"{time.monotonic() - started:.0f} s; pictures in {options.out}")
    return 1 if report.failed() else 0


if __name__ == "__main__":
    sys.exit(main())
