"""Makes the textures and meshes of `plugins/`, `blender/` and `models/`: `python make.py`, with numpy, Pillow, OpenEXR and Mitsuba 3.

All are small, smooth and made of formulas. Those who need one in another format add a line here.
"""

import struct
import zlib
from pathlib import Path

import mitsuba
import numpy as np
import OpenEXR
from PIL import Image

HERE = Path(__file__).parent
SIDE = 16


def main():
    """Writes all files."""
    textures, meshes = HERE / "plugins" / "textures", HERE / "plugins" / "meshes"
    for folder in (textures, meshes, HERE / "blender" / "textures", HERE / "blender" / "meshes"):
        folder.mkdir(parents=True, exist_ok=True)
    mitsuba.set_variant("scalar_rgb")
    write_colours(textures)
    write_greys(textures)
    write_spectra(textures)
    write_meshes(meshes)
    write_blender(HERE / "blender")
    write_model(HERE / "models")


def coordinates(side=SIDE):
    """u and v at the centres of texels, rows from the top."""
    steps = (np.arange(side) + 0.5) / side
    return np.meshgrid(steps, steps)


def colours(side=SIDE):
    """A picture that has no symmetry, so that a turned or mirrored one is noticed; 0 to 1."""
    u, v = coordinates(side)
    red = 0.15 + 0.7 * u
    green = 0.2 + 0.6 * v
    blue = 0.5 + 0.35 * np.sin(2 * np.pi * u) * np.cos(2 * np.pi * v)
    return np.stack([red, green, blue], axis=2)


def height(side=SIDE):
    """Two bumps on a wave that repeats in u and v; 0 to 1."""
    u, v = coordinates(side)
    wave = 0.5 + 0.2 * np.cos(2 * np.pi * (u + 2 * v))
    return np.clip(wave + 0.25 * np.sin(4 * np.pi * u) * np.sin(2 * np.pi * v), 0, 1)


def normals(side=SIDE):
    """The normals of a steeper `height`, as colours; right is red, up is green."""
    grey = height(side)
    du = (np.roll(grey, -1, 1) - np.roll(grey, 1, 1)) * side / 2
    dv = (np.roll(grey, -1, 0) - np.roll(grey, 1, 0)) * side / 2
    normal = np.stack([-0.08 * du, 0.08 * dv, np.ones_like(grey)], axis=2)
    return 0.5 + 0.5 * normal / np.linalg.norm(normal, axis=2, keepdims=True)


def bytes_of(values):
    """0 to 1 as 0 to 255."""
    return (np.clip(values, 0, 1) * 255 + 0.5).astype(np.uint8)


def write_colours(folder):
    """The same picture in every format."""
    eight = Image.fromarray(bytes_of(colours()))
    for name in ("colours.png", "colours.bmp", "colours.tga", "colours.ppm"):
        eight.save(folder / name)
    eight.save(folder / "colours.jpg", quality=95, subsampling=0)
    eight.save(folder / "colours-compressed.tga", compression="tga_rle")
    eight.quantize(64).save(folder / "colours-palette.png")
    eight.convert("RGBA").save(folder / "colours-alpha.png")
    sixteen = (colours() * 65535 + 0.5).astype(np.uint16)
    mitsuba.Bitmap(sixteen).write(str(folder / "colours-16.png"))
    wide = (4 * colours() ** 3).astype(np.float32)
    mitsuba.Bitmap(wide).write(str(folder / "colours.hdr"))
    mitsuba.Bitmap(wide).write(str(folder / "colours.pfm"))
    compressions = "NO RLE ZIPS ZIP PIZ PXR24 B44 B44A DWAA DWAB".split()
    for name in compressions:
        kind = np.float32 if name in ("NO", "ZIPS", "PIZ", "PXR24") else np.float16
        header = {"compression": getattr(OpenEXR, f"{name}_COMPRESSION"), "type": OpenEXR.scanlineimage}
        file_name = str(folder / f"colours-{name.lower()}.exr")
        OpenEXR.File(header, {"RGB": np.ascontiguousarray(colours(), dtype=kind)}).write(file_name)
    tiles = OpenEXR.TileDescription()
    tiles.xSize = tiles.ySize = 8
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.tiledimage, "tiles": tiles}
    OpenEXR.File(header, {"RGB": colours().astype(np.float16)}).write(str(folder / "colours-tiles.exr"))


def write_greys(folder):
    """Heights, normals, roughnesses, weights and holes."""
    u, v = coordinates()
    Image.fromarray(bytes_of(height(32))).save(folder / "height.png")
    mitsuba.Bitmap(height(64).astype(np.float16)[..., None]).write(str(folder / "height.exr"))
    Image.fromarray(bytes_of(normals())).save(folder / "normals.png")
    Image.fromarray(bytes_of(0.15 + 0.4 * u)).save(folder / "rough.png")
    Image.fromarray(bytes_of(0.5 + 0.5 * np.sin(2 * np.pi * u) * np.sin(2 * np.pi * v))).save(folder / "weight.png")
    holes = (np.hypot((2 * u) % 1 - 0.5, (2 * v) % 1 - 0.5) > 0.3).astype(float)
    Image.fromarray(bytes_of(holes)).save(folder / "holes.png")
    sky = 0.2 + 1.5 * np.exp(-8 * ((u - 0.3) ** 2 + (v - 0.3) ** 2))
    sky = np.stack([sky, 0.9 * sky, 0.5 + 0.5 * (1 - v)], axis=2)
    mitsuba.Bitmap(sky.astype(np.float32)).write(str(folder / "sky.exr"))
    mitsuba.Bitmap(np.repeat(grid()[::-1], 3, 2)).write(str(folder / "grid.png"))


def grid(side=160, line=0.05):
    """Lines around each square of 0.25, as `gridtexture` draws them: `line` wide on either side."""
    steps = (np.arange(side) + 0.5) / side * 4 % 1
    near = (steps < line) | (steps > 1 - line)
    return np.where(near[None, :] | near[:, None], 204, 51).astype(np.uint8)[..., None]


def write_spectra(folder):
    """A reflectance over wavelengths, as old scenes name files of them."""
    lines = [f"{nm} {0.1 + 0.7 * (nm - 380) / 400:.4f}" for nm in range(380, 781, 20)]
    (folder / "reddish.spd").write_text("# wavelength in nm, reflectance\n" + "\n".join(lines) + "\n")


def write_meshes(folder):
    """A hill with texture coordinates and colours as OBJ, PLY, STL and `.serialized`."""
    points, uvs, faces = hill(9)
    tints = np.stack([uvs[:, 0], uvs[:, 1], 0.5 + 0 * uvs[:, 0]], axis=1)
    write_obj(folder / "hill.obj", points, uvs, faces)
    write_ply(folder / "hill.ply", points, uvs, faces, tints)
    write_ply_binary(folder / "hill-binary.ply", points, uvs, faces, tints)
    write_stl(folder / "hill.stl", points, faces)
    write_serialized(folder / "hill.serialized", points, uvs, faces)


def hill(side, lift=0.5):
    """Points, texture coordinates and triangles of a bell over [-1, 1]², up is +z."""
    steps = np.linspace(0, 1, side)
    u, v = (a.ravel() for a in np.meshgrid(steps, steps))
    x, y = 2 * u - 1, 2 * v - 1
    points = np.stack([x, y, lift * np.exp(-3 * (x**2 + y**2))], axis=1)
    corners = [(j * side + i, j * side + i + 1, (j + 1) * side + i + 1, (j + 1) * side + i) for j in range(side - 1) for i in range(side - 1)]
    faces = [t for a, b, c, d in corners for t in ((a, b, c), (a, c, d))]
    return points, np.stack([u, v], axis=1), np.array(faces)


def write_obj(path, points, uvs, faces):
    """Positions and texture coordinates; normals are left to the reader."""
    lines = [f"v {x:.6g} {y:.6g} {z:.6g}" for x, y, z in points] + [f"vt {u:.6g} {v:.6g}" for u, v in uvs]
    lines += ["f " + " ".join(f"{i + 1}/{i + 1}" for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")


def ply_header(kind, points, faces):
    """The header with colours of vertices and of faces, named as Mitsuba names its mesh attributes."""
    vertex = "".join(f"property float {name}\n" for name in "x y z u v r g b".split())
    face = "property list uchar int vertex_indices\n" + "".join(f"property float {name}\n" for name in "rgb")
    return f"ply\nformat {kind} 1.0\nelement vertex {len(points)}\n{vertex}element face {len(faces)}\n{face}end_header\n"


def face_tints(faces):
    """A colour for each triangle, of three in turn."""
    return np.array([[0.8, 0.3, 0.2], [0.2, 0.7, 0.3], [0.3, 0.3, 0.8]])[np.arange(len(faces)) // 2 % 3]


def write_ply(path, points, uvs, faces, tints):
    """As text."""
    lines = [" ".join(f"{x:.6g}" for x in row) for row in np.concatenate([points, uvs, tints], axis=1)]
    for face, tint in zip(faces, face_tints(faces)):
        lines.append("3 " + " ".join(map(str, face)) + " " + " ".join(f"{x:.6g}" for x in tint))
    path.write_text(ply_header("ascii", points, faces) + "\n".join(lines) + "\n")


def write_ply_binary(path, points, uvs, faces, tints):
    """As binary, lowest byte first."""
    data = np.concatenate([points, uvs, tints], axis=1).astype("<f4").tobytes()
    for face, tint in zip(faces, face_tints(faces)):
        data += struct.pack("<B3i3f", 3, *map(int, face), *tint)
    path.write_bytes(ply_header("binary_little_endian", points, faces).encode() + data)


def write_stl(path, points, faces):
    """As binary: a heading, the count, and for each triangle a normal, three corners and two bytes."""
    data = b"a hill".ljust(80) + struct.pack("<I", len(faces))
    for a, b, c in points[faces]:
        normal = np.cross(b - a, c - a)
        data += struct.pack("<12fH", *(normal / np.linalg.norm(normal)), *a, *b, *c, 0)
    path.write_bytes(data)


def write_serialized(path, points, uvs, faces):
    """As Mitsuba 0.6 writes it, version 4: a packed mesh with single precision and texture coordinates, then where it begins."""
    flags = 0x1000 | 0x0002
    packed = struct.pack("<I", flags) + b"hill\0" + struct.pack("<QQ", len(points), len(faces))
    packed += points.astype("<f4").tobytes() + uvs.astype("<f4").tobytes() + faces.astype("<u4").tobytes()
    path.write_bytes(struct.pack("<HH", 0x041C, 4) + zlib.compress(packed) + struct.pack("<QI", 0, 1))


def write_blender(folder):
    """Meshes and textures as an exporter writes them: normals, texture coordinates and colours, by Mitsuba's own writer."""
    write_mesh(folder / "meshes" / "Plane.ply", *sheet(2, 2, lambda u, v: (2 * u - 1, 2 * v - 1, 0)))
    write_mesh(folder / "meshes" / "Sphere.ply", *sheet(25, 13, ball_point))
    write_mesh(folder / "meshes" / "Torus.ply", *sheet(33, 13, torus_point))
    write_mesh(folder / "meshes" / "Hill.ply", *sheet(17, 17, hill_point))
    u, v = coordinates(64)
    wave = np.sin(2 * np.pi * (6 * u + 0.8 * np.sin(2 * np.pi * v)))
    wood = np.stack([0.5 + 0.15 * wave, 0.32 + 0.1 * wave, 0.18 + 0.06 * wave], axis=2)
    Image.fromarray(bytes_of(wood)).save(folder / "textures" / "wood.jpg", quality=92)
    Image.fromarray(bytes_of(0.35 + 0.15 * wave)).save(folder / "textures" / "wood_roughness.png")
    Image.fromarray(bytes_of(normals(32))).save(folder / "textures" / "normal.png")
    leaf = np.hypot((u - 0.5) / 0.3, (v - 0.5) / (0.05 + 0.4 * np.sin(np.pi * np.clip(u, 0, 1)))) < 1
    Image.fromarray(bytes_of(leaf.astype(float))).save(folder / "textures" / "leaf.png")
    Image.fromarray(bytes_of(0.5 + 0.5 * np.sin(10 * u) * np.cos(9 * v))).save(folder / "textures" / "rust.png")
    sky = 0.25 + 0.6 * (1 - v) + 12 * np.exp(-90 * ((u - 0.3) ** 2 + (v - 0.25) ** 2))
    ground = np.where(v < 0.5, 1.0, 0.4)
    sky = np.stack([sky * ground, 0.95 * sky * ground, (sky + 0.15) * ground], axis=2)
    mitsuba.Bitmap(sky.astype(np.float16)).write(str(folder / "textures" / "world.exr"))


def sheet(columns, rows, point):
    """A grid over u and v bent to `point(u, v)`: points, texture coordinates and triangles."""
    u, v = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows)))
    points = np.array([point(*uv) for uv in zip(u, v)], dtype=float)
    corners = [(j * columns + i, (j + 1) * columns + i) for j in range(rows - 1) for i in range(columns - 1)]
    faces = [t for a, b in corners for t in ((a, a + 1, b + 1), (a, b + 1, b))]
    return points, np.stack([u, v], axis=1), np.array(faces)


def ball_point(u, v):
    """On the unit sphere; its poles lie on z."""
    return np.cos(2 * np.pi * u) * np.sin(np.pi * v), -np.sin(2 * np.pi * u) * np.sin(np.pi * v), np.cos(np.pi * v)


def torus_point(u, v):
    """On a ring of radius 1 around z, 0.35 thick."""
    reach = 1 + 0.35 * np.cos(2 * np.pi * v)
    return np.cos(2 * np.pi * u) * reach, np.sin(2 * np.pi * u) * reach, 0.35 * np.sin(2 * np.pi * v)


def hill_point(u, v):
    """A bell over [-1, 1]²."""
    x, y = 2 * u - 1, 2 * v - 1
    return x, y, 0.6 * np.exp(-3 * (x**2 + y**2))


def write_mesh(path, points, uvs, faces):
    """Binary PLY with smooth normals, and the colour attribute `vertex_Col`."""
    mesh = mitsuba.Mesh(path.stem, len(points), len(faces), has_vertex_normals=True, has_vertex_texcoords=True)
    mesh.add_attribute("vertex_Col", 3, np.stack([uvs[:, 0], 0.3 + 0.4 * uvs[:, 1], 0.8 - 0.5 * uvs[:, 0]], axis=1).ravel())
    parameters = mitsuba.traverse(mesh)
    parameters["vertex_positions"], parameters["faces"] = points.ravel(), faces.ravel()
    parameters["vertex_texcoords"] = uvs.ravel()
    parameters.update()
    mesh.recompute_vertex_normals()
    mesh.write_ply(str(path))


MATERIALS = """# Materials of dish.obj.
newmtl painted
Kd 1 1 1
map_Kd ../plugins/textures/colours.png
newmtl glossy
Kd 0.1 0.3 0.6
Ks 0.5 0.5 0.5
Ns 80
illum 2
newmtl table
Kd 0.5 0.45 0.4
newmtl lamp
Kd 0 0 0
Ke 3 2.7 2.3
"""


def write_model(folder):
    """An OBJ file that is a scene of its own: a dish, a ball, a table and a lamp, with normals and texture coordinates."""
    folder.mkdir(exist_ok=True)
    (folder / "dish.mtl").write_text(MATERIALS)
    lines, first = ["# A dish with a picture and a glossy ball on a table, under a lamp of the model's own.", "mtllib dish.mtl"], 1
    parts = {"painted": (25, 7, dish_point), "glossy": (25, 13, marble_point), "table": (2, 2, table_point), "lamp": (2, 2, lamp_point)}
    for name, (columns, rows, point) in parts.items():
        points, uvs, faces = sheet(columns, rows, lambda u, v, point=point: np.concatenate(point(u, v)))
        lines += [f"v {x:.6g} {y:.6g} {z:.6g}" for x, y, z in points[:, :3]]
        lines += [f"vn {x:.6g} {y:.6g} {z:.6g}" for x, y, z in points[:, 3:]]
        lines += [f"vt {u:.6g} {v:.6g}" for u, v in uvs] + [f"usemtl {name}"]
        lines += ["f " + " ".join(f"{i}/{i}/{i}" for i in face + first) for face in faces]
        first += len(points)
    (folder / "dish.obj").write_text("\n".join(lines) + "\n")


def dish_point(u, v):
    """Point and normal of a bowl."""
    across = np.array([np.sin(2 * np.pi * u), 0, np.cos(2 * np.pi * u)])
    normal = np.array([0, 0.75, 0]) - 0.7 * v * across
    return np.array([-0.9, 0.02 + 0.35 * v * v, 0]) + (0.15 + 0.75 * v) * across, normal / np.linalg.norm(normal)


def marble_point(u, v):
    """Point and normal of a ball."""
    across = np.array([np.sin(2 * np.pi * u), 0, np.cos(2 * np.pi * u)])
    normal = np.sin(np.pi * v) * across - np.array([0, np.cos(np.pi * v), 0])
    return np.array([0.9, 0.6, 0]) + 0.6 * normal, normal


def table_point(u, v):
    """Point and normal of a square that looks up."""
    return np.array([4.4 * u - 2.2, 0, 2.2 - 4.4 * v]), np.array([0, 1, 0])


def lamp_point(u, v):
    """Point and normal of a square that looks down."""
    return np.array([1.2 * u - 1, 3, 1.2 * v]), np.array([0, -1, 0])


if __name__ == "__main__":
    main()
