"""The page `docs/plugin-checks.md`: what `plugins.py` found, scene by scene and plugin by plugin."""

import json
import re
import xml.etree.ElementTree as xml

MOST_NAMES = 7

INTRODUCTION = """# Plugin checks

`cargo xtask conformance --plugins` renders each scene of `tests/scenes/plugins`, `blender`, `models`, `gltf` and `pbrt` in foton and in
Mitsuba 3, compares their pictures block by block, and writes this page. `tests/conformance/plugins.py` states what is compared and how
closely.

A scene that Mitsuba 3 reads is its own reference. Older files have a twin in `tests/conformance/twins`, in the words of Mitsuba 3 where it
has them, else with the published formula of the BSDF (`tests/conformance/published_bsdfs.py`), which Mitsuba's path tracer then renders.
Path tracing must agree in all blocks of 8 × 8 pixels, to {bound} and {sigmas} standard errors. Photon mapping blurs light where surfaces
end, and must agree in {share} of them. Both must agree in the mean to {bound}.

Scenes of other formats are compared with what `foton convert` makes of them, some also with a twin that was written by hand: there the
means of path tracing must agree to {format_bound}.

The laws that hold for every BSDF (a white furnace, reciprocity, densities that sum to one, and χ² tests of samples) are checked by
`crates/foton-scene/src/bsdf/tests`, and values against those of Mitsuba on a grid of directions by `tests/tests/bsdf_values.rs`.
"""


def write(findings, bounds, sigmas, share, path):
    """Writes the page; `findings` are those of `plugins.check`."""
    by_scene = {}
    for finding in findings:
        by_scene.setdefault((finding.scene, finding.reference), []).append(finding)
    bound, format_bound = map(percent, bounds)
    introduction = INTRODUCTION.format(bound=bound, format_bound=format_bound, sigmas=sigmas, share=percent(share))
    parts = [introduction, "## By plugin\n", *plugin_rows(by_scene)]
    parts += ["\n## By scene\n", *scene_rows(by_scene)]
    path.write_text("\n".join(parts) + "\n", encoding="utf-8")


def plugin_rows(by_scene):
    """A row for each plugin that a scene names itself."""
    scenes_of = {}
    for scene, reference in by_scene:
        for plugin in plugins_of(scene) if scene.suffix == ".xml" else ():
            scenes_of.setdefault(plugin, []).append((scene, reference))
    methods = methods_of(by_scene)
    yield heading("plugin", "scenes", *methods)
    for (tag, plugin), scenes in sorted(scenes_of.items()):
        found = [f for scene in scenes for f in by_scene[scene]]
        verdicts = [summary([f for f in found if f.method == method]) for method in methods]
        yield row(f"{tag} `{plugin}`", some([scene.stem for scene, _ in scenes]), *verdicts)


def some(names):
    """The first names, and how many more there are."""
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return ", ".join(names[:MOST_NAMES]) + more


def scene_rows(by_scene):
    """A row for each scene: its first comment, its reference, and a cell for each method."""
    methods = methods_of(by_scene)
    yield heading("scene", "what it shows", "reference", *methods)
    for (scene, reference), found in by_scene.items():
        cells = [next((cell(f) for f in found if f.method == method), "") for method in methods]
        name = scene.stem if scene.suffix == ".xml" else scene.name
        yield row(name, what_it_shows(scene), reference, *cells)


def methods_of(by_scene):
    """The methods, in the order of their first finding."""
    return list(dict.fromkeys(f.method for found in by_scene.values() for f in found))


def summary(findings):
    """How many agree, and the largest deviation of a mean."""
    if any(f.deviation is None for f in findings):
        return "not rendered"
    good = sum(f.good for f in findings)
    worst = max(abs(f.deviation) for f in findings)
    return f"{'agrees' if good == len(findings) else f'{good} of {len(findings)} agree'}, means to {percent(worst, 1)}"


def cell(finding):
    """The figures of one scene and method."""
    if finding.deviation is None:
        return "not rendered"
    verdict = "" if finding.good else "**differs**: "
    mean = ("+" if finding.deviation >= 0 else "−") + percent(abs(finding.deviation), 1)
    return f"{verdict}mean {mean}, worst block {percent(finding.worst, 1)}, block σ {percent(finding.sigma, 1)}"


def percent(share, digits=0):
    """As the pages of docs write it."""
    return f"{100 * share:.{digits}f} %"


def plugins_of(scene):
    """(tag, type) of all plugins that the file itself names; spelled as it spells them."""
    text = re.sub(r"<!--.*?-->", "", scene.read_text(encoding="utf-8"), flags=re.DOTALL)
    tags = ("bsdf", "texture", "shape", "emitter", "sensor")
    found = [(e.tag, e.get("type")) for e in xml.fromstring(text.strip().encode()).iter() if e.tag in tags]
    return dict.fromkeys(plugin for plugin in found if plugin[1] and not plugin[1].startswith("$"))


def what_it_shows(scene):
    """What the file says of itself, on one line."""
    if scene.parent.name == "blender":
        return "In the style of Blender's exporter"
    if scene.suffix == ".glb":
        data = scene.read_bytes()
        return of_gltf(json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")]))
    text = scene.read_text(encoding="utf-8")
    if scene.suffix == ".gltf":
        return of_gltf(json.loads(text))
    pattern = r"<!--(.*?)-->" if scene.suffix == ".xml" else r"^# *(.*?)$"
    found = re.search(pattern, text, flags=re.DOTALL | re.MULTILINE)
    return " ".join(found.group(1).split()).strip("- ") if found else ""


def of_gltf(document):
    """What a glTF file says of itself."""
    return document.get("asset", {}).get("extras", {}).get("shows", "")


def heading(*cells):
    """The first two lines of a table."""
    return row(*cells) + "\n|" + "---|" * len(cells)


def row(*cells):
    """A line of a table."""
    return "| " + " | ".join(cells) + " |"
