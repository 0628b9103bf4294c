"""foton's methods, Mitsuba 3 and LuxCore on the same scenes for the same processor time: `cargo xtask versus [SECONDS]` runs this folder.

Errors are against the mean of long runs of foton with other seeds, whose own noise is quoted; each follows new eye samples in each pass,
so that antialiasing counts. Mitsuba's kernels are compiled before its time begins. LuxCore's balls are made of triangles, and it is
given only those scenes that can be told in its words as they are.
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "conformance"))

from errors import Judge  # noqa: E402
from foton import Foton, read_image  # noqa: E402
from pictures import write_strip  # noqa: E402
from plots import write_plots  # noqa: E402
from programs import by_foton, by_luxcore, by_mitsuba  # noqa: E402
from scenes import prepare  # noqa: E402
from taking_apart import NotHanded  # noqa: E402

SIZE = 192
MAX_DEPTH = 20
SCENES = "box-spheres,cornell-diffuse,cornell-spheres,glass-and-ring,ring,pool"
METHODS = {
    "foton ppm": ["--integrator", "ppm"],
    "foton sppm": ["--integrator", "sppm"],
    "foton path": ["--integrator", "path"],
}
# The reference takes the method that converges in everything.
REFERENCE = METHODS["foton sppm"]
REFERENCE_SEEDS = [101, 102, 103, 104]


def main():
    """Renders scene by scene, prints a table, writes pictures and plots."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--foton", type=Path, required=True, help="the program")
    parser.add_argument("--repository", type=Path, required=True, help="where assets/ is")
    parser.add_argument("--out", type=Path, required=True, help="folder for pictures and the cached references")
    parser.add_argument("--luxcore", type=Path, help="a Python that has pyluxcore")
    parser.add_argument("--scenes", default=SCENES, help="of assets/, or beside the repository in shared/scenes/")
    parser.add_argument("--seconds", type=float, default=30.0, help="processor time of each program")
    parser.add_argument("--reference-seconds", type=float, help="processor time of a reference, all seeds together [20 times --seconds]")
    options = parser.parse_args()
    options.reference_seconds = options.reference_seconds or 20 * options.seconds
    options.out.mkdir(parents=True, exist_ok=True)
    foton = Foton(options.foton, options.out / "work")
    if options.luxcore is None:
        print("LuxCore: pyluxcore is not installed")

    print(f"{SIZE}×{SIZE}, {options.seconds:g} processor seconds each; error of luminance over the mean, emitters and the brightest 0.5 % left out\n", flush=True)
    plots, rows = [], {}
    for name in options.scenes.split(","):
        scene = prepare(find(options.repository, name), foton.folder, SIZE, MAX_DEPTH)
        print(name, flush=True)
        runs = long_runs(foton, name, scene, options)
        judge = Judge(runs, seen_emitters(foton, scene))
        courses = render_all(foton, scene, options)
        curves = {who: [(at, judge.error(image)) for at, image in course] for who, course in courses.items()}
        last = {who: course[-1][1] for who, course in courses.items()}
        for who, image in last.items():
            print(f"  {who:16} {curves[who][-1][1]:8.2%}   mean {judge.deviation(image):+.2%}", flush=True)
        print(f"  {'the reference':16} {judge.noise:8.2%}   (its noise)", flush=True)
        rows[name] = {"curves": curves, "noise_of_reference": judge.noise}
        plots.append((name, curves))
        write_strip(options.out / f"{name}.png", [runs.mean(axis=0), *last.values()])
        print(f"  pictures, from the left: the reference, {', '.join(last)}: {options.out / name}.png", flush=True)
        (options.out / "versus.json").write_text(json.dumps({"seconds": options.seconds, "scenes": rows}, indent=1))
        write_plots(options.out / "versus.svg", plots)
    print(f"\nerrors over time: {options.out / 'versus.svg'}")


def find(repository, name):
    """The scene's file."""
    places = [repository / "assets" / name, repository.resolve().parent / "shared" / "scenes" / name]
    [*found] = [place / "scene.xml" for place in places if (place / "scene.xml").exists()]
    if not found:
        raise SystemExit(f"{name}: no such scene")
    return found[0]


def seen_emitters(foton, scene):
    """What is seen of emitters directly."""
    image = foton.folder / "emitters.exr"
    foton.run("render", scene, "-o", image, "--integrator", "path", "--max-depth", 1, "--passes", 16)
    return read_image(image)


def long_runs(foton, name, scene, options):
    """An image a seed."""
    cached = options.out / f"reference-{name}-{options.reference_seconds:.0f}s.npy"
    if not cached.exists():
        seconds = options.reference_seconds / len(REFERENCE_SEEDS)
        print(f"  reference: {len(REFERENCE_SEEDS)} seeds of {seconds:.0f} s", flush=True)
        np.save(cached, np.stack([by_foton(foton, scene, seconds, seed, REFERENCE)[-1][1] for seed in REFERENCE_SEEDS]))
    return np.load(cached)


def render_all(foton, scene, options):
    """{program: [(seconds, image)]}."""
    courses = {who: by_foton(foton, scene, options.seconds, 1, words) for who, words in METHODS.items()}
    courses["Mitsuba path"] = by_mitsuba(scene, options.seconds)
    if options.luxcore is not None:
        try:
            courses["LuxCore BIDIRVM"] = by_luxcore(options.luxcore, foton.folder, scene, (SIZE, SIZE, MAX_DEPTH), options.seconds)
        except NotHanded as why:
            print(f"  LuxCore: {why}", flush=True)
    return courses


if __name__ == "__main__":
    main()
