"""The page `docs/plugin-checks.md`: what `plugins.py` found, scene by scene and plugin by plugin."""

import re
import xml.etree.ElementTree as xml

MOST_NAMES = 7

INTRODUCTION = """# Plugin checks

`cargo xtask conformance --plugins` renders each scene of `tests/scenes/plugins` and `tests/scenes/blender` in foton and in Mitsuba 3,
compares their pictures block by block, and writes this page. `tests/conformance/plugins.py` states what is compared and how closely.

A scene that Mitsuba 3 reads is its own reference. Older files have a twin in `tests/conformance/twins`, in the words of Mitsuba 3 where it
has them, else with the published formula of the BSDF (`tests/conformance/published_bsdfs.py`), which Mitsuba's path tracer then renders.
Path tracing must agree in all blocks of 8 × 8 pixels, to {bound} and {sigmas} standard errors. Photon mapping blurs light where surfaces
end, and must agree in {share} of them. Both must agree in the mean to {bound}.

The laws that hold for every BSDF (a white furnace, reciprocity, densities that sum to one, and χ² tests of samples) are checked by
`crates/foton-scene/src/bsdf/tests`, and values against those of Mitsuba on a grid of directions by `tests/tests/bsdf_values.rs`.
"""


def write(findings, bound, sigmas, share, path):
    """Writes the page; `findings` are those of `plugins.check`."""
    by_scene = {}
    for finding in findings:
        by_scene.setdefault(finding.scene, []).append(finding)
    parts = [INTRODUCTION.format(bound=percent(bound), sigmas=sigmas, share=percent(share)), "## By plugin\n", *plugin_rows(by_scene)]
    parts += ["\n## By scene\n", *scene_rows(by_scene)]
    path.write_text("\n".join(parts) + "\n", encoding="utf-8")


def plugin_rows(by_scene):
    """A row for each plugin that a scene names itself."""
    scenes_of = {}
    for scene in by_scene:
        for plugin in plugins_of(scene):
            scenes_of.setdefault(plugin, []).append(scene)
    methods = methods_of(by_scene)
    yield heading("plugin", "scenes", *methods)
    for (tag, plugin), scenes in sorted(scenes_of.items()):
        found = [f for scene in scenes for f in by_scene[scene]]
        verdicts = [summary([f for f in found if f.method == method]) for method in methods]
        yield row(f"{tag} `{plugin}`", some([scene.stem for scene in scenes]), *verdicts)


def some(names):
    """The first names, and how many more there are."""
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return ", ".join(names[:MOST_NAMES]) + more


def scene_rows(by_scene):
    """A row for each scene: its first comment, its reference, and a cell for each method."""
    methods = methods_of(by_scene)
    yield heading("scene", "what it shows", "reference", *methods)
    for scene, found in by_scene.items():
        cells = [next((cell(f) for f in found if f.method == method), "") for method in methods]
        yield row(scene.stem, first_comment(scene), found[0].reference, *cells)


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


def first_comment(scene):
    """The first comment, on one line."""
    if scene.parent.name == "blender":
        return "In the style of Blender's exporter"
    found = re.search(r"<!--(.*?)-->", scene.read_text(encoding="utf-8"), flags=re.DOTALL)
    return " ".join(found.group(1).split()).strip("- ") if found else ""


def heading(*cells):
    """The first two lines of a table."""
    return row(*cells) + "\n|" + "---|" * len(cells)


def row(*cells):
    """A line of a table."""
    return "| " + " | ".join(cells) + " |"
