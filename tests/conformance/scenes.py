"""Finds the scenes and makes the one file that both renderers read."""

import xml.etree.ElementTree as xml
from pathlib import Path


def find_scenes(repository):
    """(diffuse boxes, the benchmark box): those of assets/, and the diffuse box of a `shared` folder beside the repository."""
    assets, shared = repository / "assets", repository.resolve().parent / "shared" / "scenes"
    diffuse = [assets / "cornell-diffuse" / "scene.xml", shared / "cornell-box" / "scene.xml"]
    return [path for path in diffuse if path.exists()], assets / "box-spheres" / "scene.xml"


def prepare(scene, folder, size, max_depth, crop=None):
    """Copies `scene` into `folder` with the film's size, a box filter and `max_depth` written in; returns the copy's path.

    `crop` is (x, y, width, height) in pixels, for Mitsuba only.
    """
    tree = xml.parse(scene)
    root = tree.getroot()
    set_child(root.find("integrator"), "integer", "max_depth", max_depth)
    film = root.find("sensor/film")
    set_child(film, "integer", "width", size)
    set_child(film, "integer", "height", size)
    if crop is not None:
        for name, value in zip(("crop_offset_x", "crop_offset_y", "crop_width", "crop_height"), crop):
            set_child(film, "integer", name, value)
    for old in film.findall("rfilter"):
        film.remove(old)
    xml.SubElement(film, "rfilter", type="box")
    for file_name in root.iterfind(".//string[@name='filename']"):
        file_name.set("value", str((Path(scene).parent / file_name.get("value")).resolve()))

    folder.mkdir(parents=True, exist_ok=True)
    cropped = "" if crop is None else "-crop"
    prepared = folder / f"{scene_name(scene)}-{size}-depth{max_depth}{cropped}.xml"
    tree.write(prepared, encoding="unicode")
    return prepared


def scene_name(scene):
    """A short name that tells assets/cornell-box from shared/scenes/cornell-box."""
    folder = Path(scene).resolve().parent
    return folder.name if folder.parent.name == "assets" else f"{folder.parent.parent.name}-{folder.name}"


def set_child(parent, tag, name, value):
    """Sets the property `name` of `parent`, adding it where it is missing."""
    child = parent.find(f"{tag}[@name='{name}']")
    if child is None:
        child = xml.SubElement(parent, tag, name=name)
    child.set("value", str(value))
