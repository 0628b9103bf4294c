"""Check (f): the scenes of `tests/scenes/plugins`, one a plugin or dialect, of `blender` and of other formats, block by block.

A scene that Mitsuba 3 reads is its own reference. What only older versions read has a twin of the same name in `twins/`: in the words
of version 3 where it has them, else with a BSDF of `published_bsdfs.py`. A scene of another format is compared with what
`foton convert` makes of it, and with a twin written by hand where there is one: `FORMAT-NAME.xml`. Path tracing must agree in every
block. Progressive photon mapping is blurred where surfaces end, by design, so that a share of its blocks must agree, and the mean.
"""

import hashlib
import re
from dataclasses import dataclass
from pathlib import Path

import mitsuba
import numpy as np

import published_bsdfs
from diffuse_box import pooled
from pictures import write_triptych
from statistics_of_seeds import blocks, compare_means, mean_and_error

FOLDERS = ("plugins", "blender")
# Folders of scenes of other formats, and what those end in.
FORMATS = {"models": ("obj", "ply", "stl"), "gltf": ("gltf", "glb"), "pbrt": ("pbrt",)}
TWINS = Path(__file__).parent / "twins"
BLOCK = 8
BOUND = 0.02
# How far the mean of a scene of another format may lie from that of its twin.
FORMAT_BOUND = 0.01
# So wide are the pictures of scenes of other formats.
WIDTH = 64
MASK = "mask"
FILM = '<film type="hdrfilm">'
SIGMAS = 3


@dataclass
class Finding:
    """What one method made of one scene; without a deviation it did not render."""

    scene: Path
    reference: str
    method: str
    good: bool
    deviation: float | None = None
    worst: float = 0.0
    agree: float = 0.0
    sigma: float = 0.0


@dataclass
class Method:
    """How one method of foton renders, and which share of the blocks must agree."""

    name: str
    passes: int
    photons: int
    spp: int
    share: float
    radius: str | None = None


@dataclass
class Effort:
    """How much work to do; `names` are the scenes, all without."""

    seeds: int
    reference_spp: int
    methods: tuple
    names: tuple = ()


PATH = Method("path", 16, 1, 8, 1.0)
PPM = Method("ppm", 32, 1 << 14, 16, 0.9, "x0.5")
# For the pictures of `blender`, which are six times as large, and for suns, whose photons are noisy.
MORE = Method("ppm", 48, 1 << 17, 16, 0.9, "x0.5")
NEED_MORE = ("blender", "sunsky", "old")
# For light that paths find by chance, through glass and coats.
MORE_PATHS = Method("path", 64, 1, 8, 1.0)
NEED_MORE_PATHS = ("twin", "glass", "coats")


def method_for(scene, usual):
    """The method, with more work where a scene needs it."""
    if usual == PATH and scene.stem.startswith(NEED_MORE_PATHS):
        return MORE_PATHS
    needs_more = scene.parent.name in NEED_MORE or scene.stem.startswith(NEED_MORE)
    return MORE if usual == PPM and needs_more else usual


FULL = Effort(4, 512, (PATH, PPM))
QUICK = Effort(4, 256, (Method("path", 8, 1, 8, 0.97),), ("blendbsdf", "dialect-0.5", "normalmap", "phong", "principled-plastic"))


@dataclass
class Pair:
    """A scene, the file that Mitsuba renders for it, where the files lie that they share, and what the first is made smaller to."""

    scene: Path
    original: Path
    folder: Path
    kind: str
    size: tuple | None = None


def check(report, foton, theirs, repository, out, effort):
    """A row for each scene and method, and a picture; returns the findings."""
    published_bsdfs.register()
    scenes = repository / "tests" / "scenes"
    of_mitsuba = [scene for name in FOLDERS for scene in sorted((scenes / name).glob("*.xml"))]
    others = [scene for name, kinds in FORMATS.items() for kind in kinds for scene in sorted((scenes / name).glob(f"*.{kind}"))]
    wanted = [scene for scene in (*of_mitsuba, *others) if not effort.names or scene.stem in effort.names]
    findings = []
    for pair in (pair for scene in wanted for pair in pairs(foton, scene, out)):
        reference = references(theirs, pair.original, pair.folder, effort)
        for usual in effort.methods:
            method = method_for(pair.scene, usual)
            finding, why = compare(foton, pair, reference, method, effort, out)
            findings.append(finding)
            add_row(report, finding, method, why)
    return findings


def pairs(foton, scene, out):
    """What a scene is compared with."""
    if scene.parent.name in FOLDERS:
        twin = TWINS / scene.name
        original = twin if twin.exists() else scene
        yield Pair(scene, original, scene.parent, kind_of(scene, original))
        return
    # Files that Mitsuba's words name lie beside them.
    converted = out / "converted" / f"{scene.parent.name}-{scene.stem}.xml"
    converted.parent.mkdir(parents=True, exist_ok=True)
    foton.run("convert", scene, converted)
    size = make_small(converted)
    yield Pair(scene, converted, converted.parent, "its conversion", size)
    for twin in (TWINS / converted.name, scene.with_suffix(".xml")):
        if twin.exists():
            yield Pair(scene, twin, scene.parent, "Mitsuba 3, its words", size_of(twin))


def size_of(scene):
    """Width and height of the film of a scene file."""
    text = scene.read_text(encoding="utf-8")
    return tuple(int(re.search(f'name="{name}" value="([0-9]+)"', text).group(1)) for name in ("width", "height"))


def make_small(scene):
    """Gives the film of a scene file few pixels, and returns how many."""
    text = scene.read_text(encoding="utf-8")
    width, height = size_of(scene)
    size = (WIDTH, round(WIDTH * height / width))
    # Mitsuba 3.9's path tracer lets light through a mask twice: a panel of opacity 0.4 is as bright as one of 0.16.
    if f'type="{MASK}"' in text:
        text = text.replace('name="integrator" value="path"', 'name="integrator" value="volpath"')
    # foton's filters see beyond the border, Mitsuba's if asked to.
    text = text.replace(FILM, f'{FILM}<boolean name="sample_border" value="true"/>')
    for name, number in zip(("width", "height"), size):
        text = re.sub(f'name="{name}" value="[0-9]+"', f'name="{name}" value="{number}"', text)
    scene.write_text(text, encoding="utf-8")
    return size


def references(theirs, scene, folder, effort):
    """Mitsuba's images of a file, one a seed."""

    def image(seed):
        loaded = mitsuba.load_file(str(scene), optimize=False)
        return np.array(mitsuba.render(loaded, seed=seed, spp=effort.reference_spp), dtype=np.float64)[..., :3]

    parts = digest(folder)
    seeds = range(1, effort.seeds + 1)
    return np.stack([theirs.cached(scene, f"{parts}-{effort.reference_spp}spp-s{s}", lambda s=s: image(s)) for s in seeds])


def digest(folder):
    """Of all that scenes of the folder and their twins share, so that an old reference is not taken for a new one."""
    shared = [*sorted(folder.glob("*/*")), Path(published_bsdfs.__file__)]
    return hashlib.sha256(b"".join(path.read_bytes() for path in shared)).hexdigest()[:8]


def compare(foton, pair, reference, method, effort, out):
    """The finding, and why there is no picture where there is none."""
    scene, kind = pair.scene, pair.kind
    try:
        ours = np.stack([render(foton, pair, seed, method) for seed in range(1, effort.seeds + 1)])
    except SystemExit as cause:
        return Finding(scene, kind, method.name, False), str(cause).splitlines()[-1]
    name = pair.original.stem if pair.size else scene.stem
    write_triptych(out / f"plugins-{name}-{method.name}.png", ours.mean(axis=0), reference.mean(axis=0))
    mean, error = mean_and_error([blocks(image, BLOCK) for image in ours])
    expected, expected_error = mean_and_error([blocks(image, BLOCK) for image in reference])
    sigma = pooled(np.hypot(error, expected_error))
    agree = (np.abs(mean - expected) <= SIGMAS * sigma + BOUND * expected).mean()
    deviations = compare_means(*(images.mean(axis=(1, 2)) for images in (ours, reference)))[0]
    deviation = deviations[np.abs(deviations).argmax()]
    # Behind a model there may be nothing, but for what a filter brings.
    lit = expected > 0.01 * expected.mean()
    typical = np.median((sigma / np.where(lit, expected, 1))[lit])
    bound = FORMAT_BOUND if pair.size and method.name == PATH.name else BOUND
    good = bool(agree >= method.share and abs(deviation) <= bound and typical <= BOUND / 2)
    worst = np.abs(mean[lit] / expected[lit] - 1).max()
    return Finding(scene, kind, method.name, good, deviation, worst, agree, typical), ""


def kind_of(scene, original):
    """What the reference is, in words."""
    if original == scene:
        return "Mitsuba 3"
    return "published formula" if "published_" in original.read_text(encoding="utf-8") else "Mitsuba 3, its words"


def add_row(report, finding, method, why):
    """The finding as a row of the report."""
    scene = finding.scene
    name = scene.stem if scene.parent.name in FOLDERS else f"{scene.name} and {finding.reference}"
    row, bound = f"plugins: {name}, {method.name}", f"{BOUND:.0%} + {SIGMAS} σ, {method.share:.0%}"
    if finding.deviation is None:
        report.add(row, "is not rendered", bound, why, False)
    else:
        measured = f"mean {finding.deviation:+.2%}, worst block {finding.worst:.1%}, {finding.agree:.0%} agree"
        report.add(row, measured, bound, f"block σ {finding.sigma:.2%}", finding.good)


def render(foton, pair, seed, method):
    """One foton image."""
    return foton.render(pair.scene, seed, method.passes, method.photons, method.spp, method.radius, "auto", method.name, pair.size)
