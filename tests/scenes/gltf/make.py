"""Makes the glTF files of this folder: `python make.py`, with nothing but the standard library.

A file for each feature or few of them, all small, with names that say what they show. Meshes are balls, squares and cubes.
"""

import base64
import json
import math
import struct
import zlib
from pathlib import Path

HERE = Path(__file__).parent
FLOAT, UBYTE, BYTE, USHORT, SHORT, UINT = 5126, 5121, 5120, 5123, 5122, 5125
CODES = {FLOAT: "f", UBYTE: "B", BYTE: "b", USHORT: "H", SHORT: "h", UINT: "I"}
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class File:
    """A file under construction: lists of JSON objects, and bytes."""

    shows = ""

    def __init__(self):
        asset = {"version": "2.0", "generator": "tests/scenes/gltf/make.py", "extras": {"shows": self.shows}}
        self.json = {"asset": asset}
        self.bytes = bytearray()
        self.roots = []
        self.known = {}

    def add(self, name, /, **item):
        """Adds an object to a list; its number."""
        items = self.json.setdefault(name, [])
        items.append(item)
        return len(items) - 1

    def use(self, *names):
        """Names extensions."""
        used = self.json.setdefault("extensionsUsed", [])
        used.extend(name for name in names if name not in used)

    def view(self, data, **more):
        """Adds bytes; the number of their view."""
        self.bytes.extend(bytes(-len(self.bytes) % 4))
        at = len(self.bytes)
        self.bytes.extend(data)
        return self.add("bufferViews", buffer=0, byteOffset=at, byteLength=len(data), **more)

    def accessor(self, rows, component=FLOAT, stride=None, **more):
        """Adds elements, tuples or numbers, unless the same are there; the number of their accessor."""
        rows = [row if isinstance(row, (tuple, list)) else (row,) for row in rows]
        key = (tuple(map(tuple, rows)), component, stride, *more)
        if key not in self.known:
            self.known[key] = self.new_accessor(rows, component, stride, more)
        return self.known[key]

    def new_accessor(self, rows, component, stride, more):
        """Adds elements whatever is there."""
        width = len(rows[0])
        row = struct.Struct("<" + CODES[component] * width)
        pad = bytes((stride or row.size) - row.size)
        data = b"".join(row.pack(*r) + pad for r in rows)
        view = self.view(data, **({"byteStride": stride} if stride else {}))
        if component == FLOAT and width == 3:
            more["min"] = [min(r[i] for r in rows) for i in range(3)]
            more["max"] = [max(r[i] for r in rows) for i in range(3)]
        return self.add("accessors", bufferView=view, componentType=component, count=len(rows), type=TYPES[width], **more)

    def mesh(self, shape, material=None, **more):
        """Adds a mesh of one primitive: positions, normals, texture coordinates and triangles."""
        positions, normals, coordinates, triangles = shape
        attributes = {"POSITION": self.accessor(positions)}
        if normals:
            attributes["NORMAL"] = self.accessor(normals)
        if coordinates:
            attributes["TEXCOORD_0"] = self.accessor(coordinates)
        indices = self.accessor([i for t in triangles for i in t], USHORT)
        primitive = {"attributes": attributes, "indices": indices}
        if material is not None:
            primitive["material"] = material
        primitive.update(more)
        return self.add("meshes", primitives=[primitive])

    def node(self, root=True, **node):
        """Adds a node, to the scene if nothing else has it."""
        index = self.add("nodes", **node)
        if root:
            self.roots.append(index)
        return index

    def material(self, name, **more):
        """Adds a material; keys of metallic-roughness go where they belong."""
        pbr = {k: more.pop(k) for k in list(more) if k.startswith(("baseColor", "metallic", "roughness"))}
        for extension in more.get("extensions", {}):
            self.use(extension)
        return self.add("materials", name=name, pbrMetallicRoughness=pbr, **more)

    def image(self, pixels, uri=None):
        """Adds a picture, rows of tuples of 8 bits, as a PNG file."""
        data = png(pixels)
        if uri:
            (HERE / uri).write_bytes(data)
            return self.add("images", uri=uri.replace(" ", "%20"))
        return self.add("images", bufferView=self.view(data), mimeType="image/png")

    def texture(self, pixels, sampler=None, uri=None):
        """Adds a texture of a picture."""
        sampled = {} if sampler is None else {"sampler": self.add("samplers", **sampler)}
        return self.add("textures", source=self.image(pixels, uri), **sampled)

    def camera(self, origin, target, yfov=0.7, aspect=4 / 3, name="camera"):
        """Adds a perspective camera in a node of its own."""
        camera = self.add("cameras", type="perspective", perspective={"yfov": yfov, "aspectRatio": aspect, "znear": 0.01})
        return self.node(name=name, camera=camera, matrix=look(origin, target))

    def light(self, kind, intensity, origin=(0, 0, 0), target=(0, 0, 0), color=(1, 1, 1), **more):
        """Adds a light of KHR_lights_punctual, in watts by 683 lm/W."""
        self.use("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"type": kind, "intensity": 683 * intensity, "color": list(color), **more})
        extension = {"KHR_lights_punctual": {"light": len(lights) - 1}}
        return self.node(name=kind, matrix=look(origin, target), extensions=extension)

    def lamp(self, origin=(0, 4, 0), target=(0, 0, 0), half=1.0, strength=12.0):
        """Adds a square lamp that shines at a target."""
        strength = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
        material = self.material("lamp", baseColorFactor=[0, 0, 0, 1], emissiveFactor=[1, 1, 1], extensions=strength)
        matrix = look(origin, target)
        right, front = matrix[0:3], tuple(-x for x in matrix[8:11])
        columns = (right, front, cross(right, front))
        matrix = [x for column in columns for x in (*(half * c for c in column), 0)] + [*origin, 1]
        self.node(name="lamp", mesh=self.mesh(square(), material), matrix=matrix)

    def floor(self, half=6.0, colour=(0.6, 0.6, 0.6, 1)):
        """Adds a dull floor."""
        material = self.material("floor", baseColorFactor=list(colour), metallicFactor=0)
        self.node(name="floor", mesh=self.mesh(square(), material), scale=[half, 1, half])

    def finish(self, name, how="glb"):
        """Writes the file: `glb`, or `gltf` with its bytes inside or beside it."""
        self.json["scenes"] = [{"nodes": self.roots}]
        self.json["scene"] = 0
        buffer = {"byteLength": len(self.bytes)}
        self.json["buffers"] = [buffer]
        if how == "glb":
            text = json.dumps(self.json, separators=(",", ":")).encode()
            text += b" " * (-len(text) % 4)
            data = bytes(self.bytes) + bytes(-len(self.bytes) % 4)
            total = 12 + 8 + len(text) + 8 + len(data)
            head = struct.pack("<4sII", b"glTF", 2, total)
            parts = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
            (HERE / f"{name}.glb").write_bytes(head + parts)
            return
        if how == "inside":
            buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
        else:
            buffer["uri"] = f"{name}.bin"
            (HERE / f"{name}.bin").write_bytes(self.bytes)
        (HERE / f"{name}.gltf").write_text(json.dumps(self.json, indent=1) + "\n")


def png(pixels):
    """A PNG file of rows of tuples: grey with alpha, RGB or RGBA by their length."""
    kind = {1: 0, 2: 4, 3: 2, 4: 6}[len(pixels[0][0])]
    rows = b"".join(b"\0" + bytes(c for p in row for c in p) for row in pixels)

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", len(pixels[0]), len(pixels), 8, kind, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def picture(side, of):
    """A square picture of a function of u and v, from 0 to 1 with v down."""
    at = [(i + 0.5) / side for i in range(side)]
    return [[tuple(max(0, min(255, round(255 * c))) for c in of(u, v)) for u in at] for v in at]


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def look(origin, target):
    """The matrix of a node whose -z points at a target."""
    back = unit(sub(origin, target)) if origin != target else (0, 0, 1)
    up = (0, 0, -1) if abs(back[1]) > 0.999 else (0, 1, 0)
    right = unit(cross(up, back))
    up = cross(back, right)
    return [*right, 0, *up, 0, *back, 0, *origin, 1]


def ball(radius=1.0, around=32, rings=16):
    """A ball: u goes around, v down."""
    positions, normals, coordinates, triangles = [], [], [], []
    for j in range(rings + 1):
        for i in range(around + 1):
            phi, theta = 2 * math.pi * i / around, math.pi * j / rings
            n = (math.sin(theta) * math.sin(phi), math.cos(theta), math.sin(theta) * math.cos(phi))
            normals.append(n)
            positions.append(tuple(radius * x for x in n))
            coordinates.append((i / around, j / rings))
    for j in range(rings):
        for i in range(around):
            a, b = j * (around + 1) + i, (j + 1) * (around + 1) + i
            triangles += [(a, b, b + 1)] * (j + 1 < rings) + [(a, b + 1, a + 1)] * (j > 0)
    return positions, normals, coordinates, triangles


def square(repeat=1.0):
    """A square of half-side 1 on the ground, facing up; v goes towards +z."""
    positions = [(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)]
    coordinates = [(0, 0), (repeat, 0), (repeat, repeat), (0, repeat)]
    return positions, [(0, 1, 0)] * 4, coordinates, [(0, 2, 1), (0, 3, 2)]


def cube():
    """A cube of half-side 1, flat, without normals."""
    corners = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return corners, None, None, [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]


STANDING = [math.sqrt(0.5), 0, 0, math.sqrt(0.5)]
"""Turns what faces up towards the viewer, +z, with its v down."""


def metallic_roughness():
    """Balls from dull to shiny, dielectric and metal, and one whose roughness and metal come from a picture."""
    f = File()
    f.floor()
    for j, metallic in enumerate((0, 1)):
        for i, roughness in enumerate((0.2, 0.5, 1.0)):
            material = f.material(f"m{metallic}r{roughness}", baseColorFactor=[0.9, 0.5, 0.2, 1], metallicFactor=metallic, roughnessFactor=roughness)
            mesh = f.mesh(ball(0.6), material)
            f.node(name=f"ball-{j}-{i}", mesh=mesh, translation=[1.5 * i - 2.25, 0.6, 1.5 * (1 - j) - 0.75])
    mixed = f.texture(picture(16, lambda u, v: (0, 0.3 + 0.7 * v, 1 if u % 0.25 < 0.125 else 0)))
    material = f.material("mixed", baseColorFactor=[0.8, 0.8, 0.9, 1], metallicRoughnessTexture={"index": mixed}, metallicFactor=1, roughnessFactor=0.9)
    f.node(name="mixed", mesh=f.mesh(ball(0.9), material), translation=[2.6, 0.9, 0])
    f.lamp(strength=20)
    f.camera((0, 4, 7), (0.3, 0.5, 0))
    f.finish("metallic-roughness")


def textures():
    """Wrapping, filtering and transforms of a picture without symmetry; bytes and picture in files beside it."""
    f = File()
    colours = picture(8, lambda u, v: (u, v, 0.2 + 0.6 * (u > 0.5) * (v < 0.5)))
    f.floor(colour=(0.3, 0.3, 0.3, 1))
    image = f.image(colours, "textures colours.png")
    nearest = f.add("samplers", magFilter=9728, minFilter=9728)
    mirror = f.add("samplers", wrapS=33648, wrapT=33648, magFilter=9729)
    clamp = f.add("samplers", wrapS=33071, wrapT=33071)
    panels = [
        ("plain", {"source": image}, 1, {}),
        ("nearest", {"source": image, "sampler": nearest}, 1, {}),
        ("mirrored", {"source": image, "sampler": mirror}, 2, {}),
        ("clamped", {"source": image, "sampler": clamp}, 2, {}),
        ("offset", {"source": image}, 1, {"offset": [0.25, 0.5]}),
        ("turned", {"source": image}, 1, {"offset": [0, 1], "rotation": math.pi / 2}),
        ("scaled", {"source": image}, 1, {"scale": [3, 2], "rotation": 0.3}),
        ("quadrant", {"source": image}, 1, {"offset": [0, 1], "rotation": math.pi / 2, "scale": [0.5, 0.5]}),
    ]
    for i, (name, texture, repeat, transform) in enumerate(panels):
        info = {"index": f.add("textures", **texture)}
        if transform:
            info["extensions"] = {"KHR_texture_transform": transform}
            f.use("KHR_texture_transform")
        material = f.material(name, baseColorTexture=info, metallicFactor=0)
        mesh = f.mesh(square(repeat), material)
        f.node(name=name, mesh=mesh, translation=[2.2 * (i % 4) - 3.3, 3.3 - 2.2 * (i // 4), 0], rotation=STANDING)
    f.light("directional", 3, (2, 3, 5), (0, 0, 0))
    f.light("point", 20, (0, 6, 4))
    f.camera((0, 2.2, 9), (0, 2.2, 0), 0.6, 1.6)
    f.finish("textures", "beside")


def alpha():
    """Holes by a mask, veils by a blend, of pictures and of numbers."""
    f = File()
    f.floor()
    dots = f.texture(picture(32, lambda u, v: (0.9, 0.3 + 0.5 * u, 0.2, 1 if math.hypot(u % 0.25 - 0.125, v % 0.25 - 0.125) > 0.09 else 0.1)))
    fade = f.texture(picture(16, lambda u, v: (0.2, 0.5, 0.9, u)))
    cases = [
        ("mask", {"baseColorTexture": {"index": dots}, "alphaMode": "MASK"}),
        ("blend", {"baseColorTexture": {"index": fade}, "alphaMode": "BLEND"}),
        ("veil", {"baseColorFactor": [0.3, 0.9, 0.3, 0.4], "alphaMode": "BLEND"}),
        ("opaque", {"baseColorTexture": {"index": fade}}),
    ]
    for i, (name, more) in enumerate(cases):
        material = f.material(name, metallicFactor=0, doubleSided=True, **more)
        f.node(name=name, mesh=f.mesh(square(), material), translation=[2.3 * i - 3.45, 1.3, 0], rotation=STANDING)
    # No points or suns: Mitsuba's paths do not find them through what is partly there.
    f.lamp((1, 5, 6), (0, 0.5, 0), strength=60)
    f.camera((0, 3, 8), (0, 1, 0), 0.7, 1.6)
    f.finish("alpha")


def normal_map():
    """Bumps lit from the upper left: with a map, a scaled map, and mirrored coordinates, on which they must stand out as well."""
    f = File()

    def bump(u, v):
        x, y = (u * 3) % 1 - 0.5, (v * 3) % 1 - 0.5
        inside = math.hypot(x, y) < 0.4
        n = unit((2.5 * x, -2.5 * y, 1)) if inside else (0, 0, 1)
        return tuple(0.5 + 0.5 * c for c in n)

    bumps = f.texture(picture(48, bump))
    mirrored = (square()[0], square()[1], [(1 - u, v) for u, v in square()[2]], square()[3])
    for i, (name, scale, shape) in enumerate((("full", 1, square()), ("half", 0.4, square()), ("mirrored", 1, mirrored))):
        material = f.material(name, baseColorFactor=[0.7, 0.7, 0.7, 1], metallicFactor=0, normalTexture={"index": bumps, "scale": scale})
        f.node(name=name, mesh=f.mesh(shape, material), translation=[2.2 * i - 2.2, 0, 0], rotation=STANDING)
    f.light("directional", 3, (-3, 4, 4), (0, 0, 0))
    f.camera((0, 0, 6), (0, 0, 0), 0.5, 2)
    f.finish("normal-map")


def emissive():
    """What shines: a strength above 1, a picture, and an unlit surface."""
    f = File()
    f.floor()
    cells = f.texture(picture(8, lambda u, v: (1, 0.5 * u, 0.1) if (int(u * 4) + int(v * 4)) % 2 else (0, 0, 0)))
    face = f.texture(picture(8, lambda u, v: (u, 0.4, v)))
    cases = [
        ("strong", {"emissiveFactor": [1, 0.8, 0.6], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 6}}}),
        ("cells", {"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": cells}, "baseColorFactor": [0.1, 0.1, 0.1, 1]}),
        ("unlit", {"baseColorTexture": {"index": face}, "extensions": {"KHR_materials_unlit": {}}}),
    ]
    for i, (name, more) in enumerate(cases):
        material = f.material(name, metallicFactor=0, **more)
        f.node(name=name, mesh=f.mesh(square(), material), translation=[2.4 * i - 2.4, 1.1, 0], rotation=STANDING)
    f.camera((0, 3, 7), (0, 0.8, 0))
    f.finish("emissive")


def glass():
    """Clear, rough, tinted and thick glass, a pane, a rough pane, and a ball that is half clear."""
    f = File()
    f.floor()

    def glassy(transmission=1.0, ior=1.5, thickness=None, distance=None, colour=None):
        extensions = {"KHR_materials_transmission": {"transmissionFactor": transmission}, "KHR_materials_ior": {"ior": ior}}
        if thickness is not None:
            volume = {"thicknessFactor": thickness}
            if distance is not None:
                volume.update(attenuationDistance=distance, attenuationColor=colour)
            extensions["KHR_materials_volume"] = volume
        return extensions

    balls = [
        ("clear", [1, 1, 1, 1], 0, glassy(thickness=1)),
        ("rough", [1, 1, 1, 1], 0.4, glassy(thickness=1)),
        ("tinted", [1, 1, 1, 1], 0, glassy(ior=1.33, thickness=1, distance=0.7, colour=[0.2, 0.6, 0.9])),
        ("half", [0.9, 0.4, 0.2, 1], 0.2, glassy(transmission=0.5, thickness=1)),
    ]
    for i, (name, colour, roughness, extensions) in enumerate(balls):
        material = f.material(name, baseColorFactor=colour, metallicFactor=0, roughnessFactor=roughness, extensions=extensions)
        f.node(name=name, mesh=f.mesh(ball(0.7, 48, 24), material), translation=[1.7 * i - 2.55, 0.75, 0.5])
    for i, (name, roughness) in enumerate((("pane", 0), ("rough-pane", 0.4))):
        material = f.material(name, baseColorFactor=[0.6, 0.9, 0.6, 1], metallicFactor=0, roughnessFactor=roughness, extensions=glassy())
        f.node(name=name, mesh=f.mesh(square(), material), translation=[3 * i - 1.5, 1.05, -1.2], rotation=STANDING)
    f.lamp(strength=16)
    f.camera((0, 3.2, 7), (0, 0.6, 0))
    f.finish("glass")


def coats():
    """A clear coat, reflections without and with more of it, sheen, and what is left out with a warning."""
    f = File()
    f.floor()
    cases = [
        ("plain", 0.6, {}),
        ("coated", 0.6, {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.1}}),
        ("no-highlight", 0.2, {"KHR_materials_specular": {"specularFactor": 0}}),
        ("high-index", 0.2, {"KHR_materials_ior": {"ior": 2.2}}),
        ("sheen", 0.8, {"KHR_materials_sheen": {"sheenColorFactor": [0.8, 0.8, 0.8], "sheenRoughnessFactor": 0.5}}),
        ("left-out", 0.3, {"KHR_materials_anisotropy": {"anisotropyStrength": 0.8}, "KHR_materials_iridescence": {"iridescenceFactor": 1}}),
    ]
    for i, (name, roughness, extensions) in enumerate(cases):
        material = f.material(name, baseColorFactor=[0.6, 0.1, 0.1, 1], metallicFactor=0, roughnessFactor=roughness, extensions=extensions)
        f.node(name=name, mesh=f.mesh(ball(0.7), material), translation=[1.6 * (i % 3) - 1.6, 0.7, 1.6 * (i // 3) - 0.8])
    f.json["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "other"}]}}
    f.use("KHR_materials_variants")
    f.lamp(strength=16)
    f.camera((0, 3.6, 6), (0, 0.5, 0))
    f.finish("coats")


def lights():
    """A point, a spot and a sun, of three colours."""
    f = File()
    f.floor()
    material = f.material("ball", baseColorFactor=[0.8, 0.8, 0.8, 1], metallicFactor=0)
    f.node(name="ball", mesh=f.mesh(ball(0.7), material), translation=[0, 0.7, 0])
    f.light("point", 8, (-2.5, 1.5, 1), color=(1, 0.3, 0.2))
    f.light("spot", 40, (3, 4, 1), (1.5, 0, 0.5), (0.2, 1, 0.3), spot={"innerConeAngle": 0.2, "outerConeAngle": 0.4})
    f.light("directional", 0.8, (2, 3, 4), (0, 0, 0), (0.4, 0.5, 1))
    f.camera((0, 4, 7), (0, 0.3, 0))
    f.finish("lights")


def instances():
    """A mesh many times: by nodes within nodes, one of them mirrored, and by EXT_mesh_gpu_instancing with packed rotations."""
    f = File()
    f.floor()
    corner = ([(0, 0, 0), (1, 0, 0), (0, 1.5, 0), (0, 0, 0.5)], None, None, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    mesh = f.mesh(corner, f.material("corner", baseColorFactor=[0.8, 0.5, 0.2, 1], metallicFactor=0))
    inner = f.node(root=False, name="inner", mesh=mesh, translation=[1, 0, 0])
    mirrored = f.node(root=False, name="mirrored", mesh=mesh, translation=[-1, 0, 0], scale=[-1, 1, 1])
    f.node(name="group", children=[inner, mirrored], translation=[0, 0, -1.5], rotation=[0, math.sin(0.2), 0, math.cos(0.2)])
    turns = [2 * math.pi * i / 12 for i in range(12)]
    packed = [(0, round(32767 * math.sin(t / 2)), 0, round(32767 * math.cos(t / 2))) for t in turns]
    attributes = {
        "TRANSLATION": f.accessor([(2.5 * math.cos(t), 0, 1 + 1.5 * math.sin(t)) for t in turns]),
        "ROTATION": f.accessor(packed, SHORT, normalized=True),
        "SCALE": f.accessor([(0.4 + 0.03 * i,) * 3 for i in range(12)]),
    }
    extension = "EXT_mesh_gpu_instancing"
    f.use(extension)
    f.json["extensionsRequired"] = [extension]
    f.node(name="ring", mesh=mesh, extensions={extension: {"attributes": attributes}})
    f.lamp(strength=16)
    f.camera((0, 4, 8), (0, 0.3, 0))
    f.finish("instances")


def packed():
    """Numbers of few bits, sparse ones, indices of all kinds, strips and fans, interleaved or with room between."""
    f = File()
    f.floor()
    f.use("KHR_mesh_quantization")
    f.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    grey = f.material("grey", baseColorFactor=[0.7, 0.7, 0.7, 1], metallicFactor=0)
    positions, normals, coordinates, triangles = ball(1, 16, 8)
    shorts = [tuple(round(32767 * x) for x in p) for p in positions]
    bytes_ = [tuple(round(127 * x) for x in n) for n in normals]
    primitive = {
        "attributes": {
            "POSITION": f.accessor(shorts, SHORT, 8, normalized=True),
            "NORMAL": f.accessor(bytes_, BYTE, 4, normalized=True),
            "TEXCOORD_0": f.accessor([tuple(round(65535 * x) for x in c) for c in coordinates], USHORT, normalized=True),
        },
        "indices": f.accessor([i for t in triangles for i in t], UBYTE),
        "material": grey,
    }
    f.node(name="quantised", mesh=f.add("meshes", primitives=[primitive]), translation=[-2.4, 0.7, 0], scale=[0.7, 0.7, 0.7])
    # A flat square of which one corner is lifted, by a sparse accessor.
    flat = f.new_accessor(square()[0], FLOAT, None, {})
    sparse = {
        "count": 1,
        "indices": {"bufferView": f.view(struct.pack("<H", 2)), "componentType": USHORT},
        "values": {"bufferView": f.view(struct.pack("<3f", 1, 1.5, 1))},
    }
    f.json["accessors"][flat]["sparse"] = sparse
    lifted = {"attributes": {"POSITION": flat}, "indices": f.accessor([0, 2, 1, 0, 3, 2], UINT), "material": grey}
    f.node(name="sparse", mesh=f.add("meshes", primitives=[lifted]), translation=[-0.8, 0.1, 0], scale=[0.7, 0.7, 0.7])
    strip = f.accessor([(0.35 * (i // 2), 1.2 * (1 - i % 2), 0.2 * math.sin(i // 2)) for i in range(10)])
    f.node(name="strip", mesh=f.add("meshes", primitives=[{"attributes": {"POSITION": strip}, "mode": 5, "material": grey}]), translation=[0.3, 0.1, 0])
    rim = [(0, 0.6, 0.4)] + [(0.6 * math.cos(t), 0.6 + 0.6 * math.sin(t), 0) for t in (2 * math.pi * i / 10 for i in range(11))]
    fan = [{"attributes": {"POSITION": f.accessor(rim)}, "mode": 6, "material": grey}, {"attributes": {"POSITION": flat}, "mode": 1}]
    f.node(name="fan", mesh=f.add("meshes", primitives=fan), translation=[2.6, 0.1, 0])
    f.lamp(strength=16)
    f.camera((0, 3, 7), (0, 0.5, 0))
    f.finish("packed")


def cameras():
    """Two cameras in nodes that are turned and scaled, one without perspective, and the bytes inside of the text."""
    f = File()
    f.floor()
    for i, colour in enumerate(([0.8, 0.2, 0.2, 1], [0.2, 0.8, 0.2, 1], [0.2, 0.2, 0.8, 1])):
        material = f.material(f"cube-{i}", baseColorFactor=colour, metallicFactor=0)
        f.node(name=f"cube-{i}", mesh=f.mesh(cube(), material), translation=[1.5 * i - 1.5, 0.5, -0.5 * i], scale=[0.5, 0.5, 0.5])
    f.light("directional", 3, (2, 4, 3), (0, 0, 0))
    f.light("point", 6, (-2, 3, 2))
    f.camera((0, 2, 6), (0, 0.5, 0), name="front")
    side = f.add("cameras", name="side", type="perspective", perspective={"yfov": 0.9, "znear": 0.1, "zfar": 100})
    inner = f.node(root=False, camera=side, translation=[0, 0, 5])
    f.node(name="arm", children=[inner], translation=[0, 0.5, 0], scale=[1.2, 1.2, 1.2], rotation=[0, math.sin(0.6), 0, math.cos(0.6)])
    flat = f.add("cameras", name="plan", type="orthographic", orthographic={"xmag": 3, "ymag": 2, "znear": 0.1, "zfar": 50})
    f.node(name="plan", camera=flat, matrix=look((0, 10, 0), (0, 0, 0)))
    f.finish("cameras", "inside")


def colours():
    """Colours and opacities of vertices, and texture coordinates of a second set."""
    f = File()
    f.floor()
    shape = square()
    corners = [(255, 40, 40, 255), (40, 255, 40, 255), (40, 40, 255, 255), (255, 255, 40, 0)]
    face = f.texture(picture(8, lambda u, v: (0.9, 0.9 * u, 0.2) if (int(u * 4) + int(v * 4)) % 2 else (0.1, 0.2, 0.9 * v)))
    cases = [
        ("vertices", {}, {"COLOR_0": f.accessor(corners, UBYTE, normalized=True)}),
        ("fading", {"alphaMode": "BLEND"}, {"COLOR_0": f.accessor(corners, UBYTE, normalized=True)}),
        ("tinted", {"baseColorTexture": {"index": face}}, {"COLOR_0": f.accessor([(0.4, 0.8, 1.0)] * 4)}),
        ("second-set", {"baseColorTexture": {"index": face, "texCoord": 1}}, {"TEXCOORD_1": f.accessor([(0.5 * u, 0.5 * v) for u, v in shape[2]])}),
    ]
    for i, (name, more, attributes) in enumerate(cases):
        mesh = f.mesh(shape, f.material(name, metallicFactor=0, **more))
        f.json["meshes"][mesh]["primitives"][0]["attributes"].update(attributes)
        f.node(name=name, mesh=mesh, translation=[2.3 * i - 3.45, 1.2, 0], rotation=STANDING)
    f.lamp((0, 4, 6), (0, 0.5, 0), strength=50)
    f.camera((0, 2, 8), (0, 1, 0), 0.6, 1.6)
    f.finish("colours")


def pose():
    """A post that a skin bends to the right by the way its joints stand, and a cube that is half blended into another shape."""
    f = File()
    f.floor()
    grey = f.material("grey", baseColorFactor=[0.7, 0.6, 0.5, 1], metallicFactor=0)
    rings, sides, height = 8, 12, 2.0
    positions, normals, triangles, joints, weights = [], [], [], [], []
    for j in range(rings + 1):
        for i in range(sides):
            t = 2 * math.pi * i / sides
            normals.append((math.sin(t), 0, math.cos(t)))
            positions.append((0.2 * math.sin(t), height * j / rings, 0.2 * math.cos(t)))
            joints.append((0, 1, 0, 0))
            share = min(1, max(0, 2 * j / rings - 0.5))
            weights.append((1 - share, share, 0, 0))
            if j < rings:
                a, b = j * sides + i, j * sides + (i + 1) % sides
                triangles += [(a, b, b + sides), (a, b + sides, a + sides)]
    mesh = f.mesh((positions, normals, None, triangles), grey)
    f.json["meshes"][mesh]["primitives"][0]["attributes"].update(JOINTS_0=f.accessor(joints, UBYTE), WEIGHTS_0=f.accessor(weights))
    upper = f.node(root=False, name="upper", translation=[0, 1, 0], rotation=[0, 0, math.sin(-0.5), math.cos(-0.5)])
    lower = f.node(name="lower", children=[upper], translation=[-1.2, 0, 0])
    identity = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
    inverse = f.accessor([identity, identity[:13] + (-1,) + identity[14:]])
    skin = f.add("skins", joints=[lower, upper], inverseBindMatrices=inverse)
    f.node(name="post", mesh=mesh, skin=skin, translation=[9, 9, 9])
    blended = f.mesh(cube(), grey)
    target = f.accessor([(0, 0.8, 0) if y > 0 else (0, 0, 0) for _, y, _ in cube()[0]])
    f.json["meshes"][blended]["primitives"][0]["targets"] = [{"POSITION": target}]
    f.json["meshes"][blended]["weights"] = [0.5]
    f.node(name="cube", mesh=blended, translation=[1.2, 0.6, 0], scale=[0.6, 0.6, 0.6])
    sampler = {"input": f.accessor([0.0, 1.0]), "output": f.accessor([(0, 0, 0), (1, 0, 0)])}
    f.add("animations", channels=[{"sampler": 0, "target": {"node": upper, "path": "translation"}}], samplers=[sampler])
    f.lamp(strength=16)
    f.camera((0, 2.5, 6), (0, 0.9, 0))
    f.finish("pose")


def bare():
    """A mesh alone: no camera, no light, no material."""
    f = File()
    f.node(name="ball", mesh=f.mesh(ball(1)))
    f.node(name="cube", mesh=f.mesh(cube()), translation=[1.5, -0.5, 0.5], scale=[0.5, 0.5, 0.5])
    f.finish("bare")


if __name__ == "__main__":
    for make in (metallic_roughness, textures, alpha, normal_map, emissive, glass, coats, lights, instances, packed, cameras, colours, pose, bare):
        File.shows = make.__doc__
        make()
