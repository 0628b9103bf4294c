"""Writes Tungsten's `materialtest.json` as a Mitsuba 3 scene: `python tungsten.py materialtest.json out.xml`.

Not a general converter: it knows what that one scene uses, and stops at anything else. Meshes and images stay where they are.
Three things have no counterpart in Mitsuba 3 and are approximated:

- `smooth_coat`, a clear coat with an absorbing layer over rough copper, becomes `plastic` of the coat's index: the coat's
  reflections are kept, the metal's broad highlight is not. The base's colour is copper's times what the layer lets through
  straight down and up again.
- `tonemap`, the sampling hints and `bump_strength` do not say what light there is, and are left out.
- A checkerboard's phase may differ by one square.
"""

import json
import math
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

# Copper at normal incidence, linear sRGB.
COPPER = (0.955, 0.638, 0.538)


def main():
    """Reads the first argument, writes the second."""
    source, target = Path(sys.argv[1]), Path(sys.argv[2])
    tree = xml.ElementTree(convert(json.loads(source.read_text()), source.resolve().parent))
    xml.indent(tree, "    ")
    tree.write(target, encoding="unicode")


def convert(scene, folder):
    """The <scene> element."""
    root = xml.Element("scene", version="3.0.0")
    xml.SubElement(root, "default", name="integrator", value="path")
    integrator = xml.SubElement(root, "integrator", type="$integrator")
    value(integrator, "integer", "max_depth", scene["integrator"]["max_bounces"] + 1)
    sensor(root, scene["camera"])
    named = {bsdf["name"]: bsdf for bsdf in scene["bsdfs"]}
    for primitive in scene["primitives"]:
        kind = primitive["type"]
        matrix = placed(primitive["transform"])
        if kind == "infinite_sphere":
            emitter = xml.SubElement(root, "emitter", type="envmap")
            value(emitter, "string", "filename", folder / primitive["emission"])
            # Both have up = +y, but the image's middle is +x there and +z here.
            to_world(emitter, product(matrix, rotation(1, 90)))
            continue
        if kind == "mesh":
            shape = xml.SubElement(root, "shape", type="ply")
            value(shape, "string", "filename", folder / Path(primitive["file"]).with_suffix(".ply").name)
        elif kind == "quad":
            # A unit square in x and z there; [-1, 1]² in x and y here.
            shape = xml.SubElement(root, "shape", type="rectangle")
            matrix = product(matrix, scaling(0.5), rotation(0, -90))
        else:
            raise SystemExit(f"unknown primitive {kind}")
        shape.set("id", primitive["name"])
        to_world(shape, matrix)
        material(shape, named[primitive["bsdf"]], named)
    return root


def sensor(root, camera):
    """The camera; `fov` is across the width in both."""
    element = xml.SubElement(root, "sensor", type="perspective")
    value(element, "float", "fov", camera["fov"])
    place = camera["transform"]
    text = {to: ", ".join(map(str, place[of])) for to, of in (("origin", "position"), ("target", "look_at"), ("up", "up"))}
    xml.SubElement(xml.SubElement(element, "transform", name="to_world"), "lookat", text)
    film = xml.SubElement(element, "film", type="hdrfilm")
    value(film, "integer", "width", camera["resolution"][0])
    value(film, "integer", "height", camera["resolution"][1])
    xml.SubElement(film, "rfilter", type=camera["reconstruction_filter"])


def material(shape, bsdf, named):
    """The BSDF of a shape; all are seen from both sides."""
    outer = xml.SubElement(shape, "bsdf", type="twosided")
    if bsdf["type"] == "lambert":
        element = xml.SubElement(outer, "bsdf", type="diffuse")
        colour(element, "reflectance", bsdf["albedo"])
    elif bsdf["type"] == "smooth_coat" and named[bsdf["substrate"]]["material"] == "Cu":
        element = xml.SubElement(outer, "bsdf", type="plastic")
        value(element, "float", "int_ior", bsdf["ior"])
        through = [math.exp(-2 * bsdf["thickness"] * sigma) for sigma in bsdf["sigma_a"]]
        colour(element, "diffuse_reflectance", [c * t for c, t in zip(COPPER, through)])
    else:
        raise SystemExit(f"unknown bsdf {bsdf['type']}")


def colour(element, name, albedo):
    """A grey, a colour or a checkerboard."""
    if not isinstance(albedo, dict):
        grey = isinstance(albedo, (int, float))
        value(element, "rgb", name, ", ".join(f"{c:.6g}" for c in ([albedo] * 3 if grey else albedo)))
        return
    if albedo["type"] != "checker":
        raise SystemExit(f"unknown texture {albedo['type']}")
    texture = xml.SubElement(element, "texture", type="checkerboard", name=name)
    colour(texture, "color0", albedo["on_color"])
    colour(texture, "color1", albedo["off_color"])
    # Two squares a unit of u here.
    scale = xml.SubElement(xml.SubElement(texture, "transform", name="to_uv"), "scale")
    scale.attrib.update(x=str(albedo["res_u"] / 2), y=str(albedo["res_v"] / 2))


def placed(transform):
    """Scale, then turns about z, x and (backwards) y, then the move."""
    x, y, z = transform.get("rotation", (0, 0, 0))
    turned = product(rotation(1, -y), rotation(0, x), rotation(2, z), scaling(transform.get("scale", 1)))
    for row, shift in zip(turned, transform.get("position", (0, 0, 0))):
        row[3] = shift
    return turned


def rotation(axis, degrees):
    """Right-handed, about x, y or z."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    matrix = scaling(1)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix[i][i] = matrix[j][j] = c
    matrix[i][j], matrix[j][i] = -s, s
    return matrix


def scaling(factor):
    """The same along all axes."""
    return [[(factor if i < 3 else 1) * float(i == j) for j in range(4)] for i in range(4)]


def product(first, *others):
    """The product of 4×4 matrices."""
    for other in others:
        first = [[sum(a * b for a, b in zip(row, column)) for column in zip(*other)] for row in first]
    return first


def to_world(element, matrix):
    """Adds the transform, row by row."""
    numbers = " ".join(f"{number:.9g}" for row in matrix for number in row)
    xml.SubElement(xml.SubElement(element, "transform", name="to_world"), "matrix", value=numbers)


def value(element, tag, name, content):
    """Adds a property."""
    xml.SubElement(element, tag, name=name, value=str(content))


if __name__ == "__main__":
    main()
