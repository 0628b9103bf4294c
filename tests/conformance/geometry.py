"""How much of a photon disc lies on the surface: the whole story of photon mapping's darkening near edges.

The estimate at x divides by πr² whatever lies inside the disc. Beside an edge part of the disc lies off the surface, or behind
another one, and photons that land on the other side of a concave edge do not count, because their normal differs. Where the
light changes little over r the image is then the true one times the share of the disc that is on the surface.
"""

import math

import mitsuba
import numpy as np

ALPHA = 2.0 / 3.0

# Where a pixel's hit points are taken: off its diagonals, on which the edges of a box seen head-on lie.
WITHIN_PIXEL = ((0.15, 0.45), (0.55, 0.2), (0.4, 0.8), (0.85, 0.6))


def squared_radii(passes, alpha=ALPHA):
    """r²/r0² of each pass on a surface where photons fall evenly: Π (j+α)/(j+1)."""
    factors = [1.0]
    for j in range(passes - 1):
        factors.append(factors[-1] * (j + alpha) / (j + 1))
    return np.array(factors)


def disc_offsets(squares):
    """One offset on the unit disc per square radius, evenly spread (a Vogel spiral), scaled by that radius."""
    count = len(squares)
    # Neighbours on the spiral have nearly one radius, so the passes are dealt out in a stride coprime to the count.
    stride = next(step for step in range(count * 2 // 5 + 1, 2 * count) if math.gcd(step, count) == 1)
    offsets = []
    for i in range(count):
        radius = math.sqrt((i + 0.5) / count * squares[i * stride % count])
        angle = i * math.pi * (3 - math.sqrt(5))
        offsets.append((radius * math.cos(angle), radius * math.sin(angle)))
    return offsets


def ring_offsets(count):
    """Points on the unit circle."""
    return [(math.cos(i * math.tau / count), math.sin(i * math.tau / count)) for i in range(count)]


def disc_share(scene, size, radius, offsets):
    """For each pixel the mean share of the discs around its hit points that lies on the surface (1 where nothing is hit)."""
    share = np.ones((size, size))
    for y in range(size):
        for x in range(size):
            shares = [share_at(scene, (x + u) / size, (y + v) / size, radius, offsets) for u, v in WITHIN_PIXEL]
            share[y, x] = sum(shares) / len(shares)
    return share


def share_at(scene, x, y, radius, offsets):
    """The share of one disc, around what the eye sees at (x, y) of the unit film."""
    ray, _ = scene.sensors()[0].sample_ray(0.0, 0.5, [x, y], [0.5, 0.5])
    surface = scene.ray_intersect(ray)
    if not surface.is_valid():
        return 1.0
    normal = surface.n if surface.n @ ray.d < 0 else -surface.n
    frame = mitsuba.Frame3f(normal)
    tangent, bitangent = frame.s * radius, frame.t * radius
    return sum(on_surface(scene, surface.p, normal, tangent * u + bitangent * v, radius) for u, v in offsets) / len(offsets)


def on_surface(scene, centre, normal, offset, radius):
    """Whether the point at `offset` in the tangent plane is on the surface and not behind something."""
    height = 0.1 * radius
    lifted = centre + normal * height
    across = mitsuba.Ray3f(lifted, offset)
    across.maxt = 1.0
    if scene.ray_test(across):
        return False
    down = mitsuba.Ray3f(lifted + offset, -normal)
    down.maxt = 2 * height
    return scene.ray_test(down)
