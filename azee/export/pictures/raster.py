"""A small software rasteriser: triangles to pixels, the same on every machine.

Two passes use a z-buffer. `fill` finds the nearest triangle of every sample. `shade` lights only
visible triangles, a pixel at a time: once for each triangle in the pixel, weighted by its samples.
A second z-buffer, filled from the place of the key light, gives its shadow. The first z-buffer
darkens creases.

Numba compiles the kernels once and caches them on disk. There is no fast-math and no thread inside,
so that the same input gives the same picture. The kernels release Python's lock, so that frames of
a film can be drawn at the same time.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_FAR = 1e30
_RING = np.array([[1.0, 0.0], [0.7071, 0.7071], [0.0, 1.0], [-0.7071, 0.7071]])
"""Directions in which creases are searched, each with its opposite."""

_fill_types = "void(f8[:,::1], i8[:,::1], f8[:,::1], i4[:,::1])"


@njit(_fill_types, cache=True, nogil=True)
def fill(screen: Any, triangles: Any, depth: Any, seen: Any) -> None:
    """Fill a z-buffer.

    Args: screen: (N, 3) x and y in samples, and a depth that is affine on the screen and grows
    away from the eye; a vertex that is not in front of the eye has depth ≥ 1e30. triangles:
    (F, 3). depth: (H, W), set beforehand to 1e30. seen: (H, W) gets triangle numbers, set
    beforehand to −1.
    """
    height, width = depth.shape
    for t in range(triangles.shape[0]):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        az, bz, cz = screen[a, 2], screen[b, 2], screen[c, 2]
        if az >= _FAR or bz >= _FAR or cz >= _FAR:
            continue
        ax, ay = screen[a, 0], screen[a, 1]
        bx, by = screen[b, 0], screen[b, 1]
        cx, cy = screen[c, 0], screen[c, 1]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0.0:
            continue
        x0 = max(0, int(np.ceil(min(ax, bx, cx) - 0.5)))
        x1 = min(width - 1, int(np.floor(max(ax, bx, cx) - 0.5)))
        y0 = max(0, int(np.ceil(min(ay, by, cy) - 0.5)))
        y1 = min(height - 1, int(np.floor(max(ay, by, cy) - 0.5)))
        inverse = 1.0 / area
        u_step, v_step = -(cy - by) * inverse, -(ay - cy) * inverse
        for y in range(y0, y1 + 1):
            py = y + 0.5
            px = x0 + 0.5
            u_row = ((cx - bx) * (py - by) - (cy - by) * (px - bx)) * inverse
            v_row = ((ax - cx) * (py - cy) - (ay - cy) * (px - cx)) * inverse
            for x in range(x0, x1 + 1):
                u = u_row + (x - x0) * u_step
                v = v_row + (x - x0) * v_step
                w = 1.0 - u - v
                if u >= 0.0 and v >= 0.0 and w >= 0.0:
                    z = u * az + v * bz + w * cz
                    if z < depth[y, x]:
                        depth[y, x] = z
                        seen[y, x] = t


@njit("f8(f8[::1], f8[::1], f8[:,::1], f8[:,::1], i8, f8)", cache=True, nogil=True)
def _lit(p: Any, n: Any, shadow_from: Any, shadow: Any, size: Any, texel_m: Any) -> Any:
    """Return the share of the key light at a place, by nine samples of the shadow buffer."""
    s = np.empty(3)
    for r in range(3):
        s[r] = shadow_from[3, r]
        for k in range(3):
            s[r] += shadow_from[r, k] * (p[k] + 3.0 * texel_m * n[k])
    free = 0.0
    for i in range(3):
        for j in range(3):
            x = int(np.floor(s[0] + 1.6 * (i - 1)))
            y = int(np.floor(s[1] + 1.6 * (j - 1)))
            outside = x < 0 or y < 0 or x >= size or y >= size
            if outside or shadow[y, x] > s[2] - 2.0 * texel_m:
                free += 1.0
    return free / 9.0


@njit("f8(f8[:,::1], i8, i8, f8)", cache=True, nogil=True)
def _open(depth: Any, x: Any, y: Any, reach: Any) -> Any:
    """Return the share of the surroundings that a sample sees: less in creases and between fingers.

    It compares opposite sides at once, so that a tilted surface counts as flat. A surface far in
    front does not darken the surface behind it.

    Args: depth: as of `fill`, −1 / distance. reach: samples a metre at distance 1.
    """
    height, width = depth.shape
    here = -1.0 / depth[y, x]
    covered = 0.0
    for ring in range(2):
        radius_m = 0.02 + 0.03 * ring
        step = radius_m * reach / here
        for k in range(4):
            i, j = step * _RING[k, 0], step * _RING[k, 1]
            both = 0.0
            for side in range(-1, 2, 2):
                v = min(max(int(y + side * j), 0), height - 1)
                u = min(max(int(x + side * i), 0), width - 1)
                there = depth[v, u]
                ahead = -radius_m if there >= 0.0 else here + 1.0 / there
                if ahead > 2.0 * radius_m:
                    ahead = 0.0
                both += min(max(ahead, -radius_m), radius_m) / radius_m
            covered += max(both, 0.0)
    return 1.0 - 0.6 * min(covered / 8.0, 1.0)


@njit("f8(f8, f8[::1])", cache=True, nogil=True)
def _encoded(linear: Any, curve: Any) -> Any:
    """Encode linear light through a table over [0, 1], highlights rolled off towards white."""
    knee = 0.8
    if linear > knee:
        over = linear - knee
        linear = knee + (1.0 - knee) * (over / (1.0 - knee + over))
    return curve[int(max(linear, 0.0) * (curve.shape[0] - 1))]


_shade_types = (
    "void(f8[:,::1], f8[:,::1], i8[:,::1], f8[:,::1], f8[:,::1], f8[:,::1], f8[::1], f8[:,::1],"
    " i4[:,::1], f8[::1], f8, f8[::1], f8[:,::1], f8[:,::1], f8[:,::1], f8, i8, f8[:,::1],"
    " f8[::1], u1[:,:,::1])"
)


@njit(_shade_types, cache=True, nogil=True)
def shade(
    screen: Any,
    inverse_w: Any,
    triangles: Any,
    places: Any,
    normals: Any,
    colours: Any,
    roughness: Any,
    depth: Any,
    seen: Any,
    eye: Any,
    reach: Any,
    sun: Any,
    lights: Any,
    shadow_from: Any,
    shadow: Any,
    texel_m: Any,
    samples: Any,
    background: Any,
    curve: Any,
    out: Any,
) -> None:
    """Light what every pixel shows and encode it.

    Args: screen, triangles, depth, seen: as in `fill`. inverse_w: (N, 1) reciprocal distance along
    the view, for interpolation true to perspective. places, normals: (N, 3) in the world. colours:
    (N, 3) linear. roughness: (F,). eye, sun: (3,) the eye's place and the unit direction towards
    the key light. reach: samples a metre at distance 1. lights: (4, 3) linear colours of key, sky,
    ground and rim. shadow_from: (4, 3) rows that map a place to x, y and depth of the shadow
    buffer, and their constants. shadow: (S, S) depths; texel_m: metres between its samples.
    samples: samples per pixel, each way. background: (H / samples, 3) linear, by row. curve: a
    table of the encoding over [0, 1]. out: (H / samples, W / samples, 3) the picture over the
    background, or with 4 the light alone and its coverage.
    """
    rows, columns, channels = out.shape
    size = shadow.shape[0]
    bary = np.empty(3)
    n = np.empty(3)
    p = np.empty(3)
    base = np.empty(3)
    view = np.empty(3)
    pixel = np.empty(3)
    whole = samples * samples
    bare = np.empty(3, dtype=np.uint8)
    for v0 in range(rows):
        for k in range(3):
            bare[k] = np.uint8(_encoded(background[v0, k], curve) * 255.0 + 0.5)
        for u0 in range(columns):
            pixel[:] = 0.0
            cover = 0
            free = 0.0
            for first in range(whole):
                y, x = v0 * samples + first // samples, u0 * samples + first % samples
                t = seen[y, x]
                if t < 0:
                    continue
                count, px, py, fresh = 0, 0.0, 0.0, True
                for other in range(whole):
                    i, j = v0 * samples + other // samples, u0 * samples + other % samples
                    if seen[i, j] == t:
                        if other < first:
                            fresh = False
                            break
                        count += 1
                        px += j + 0.5
                        py += i + 0.5
                if not fresh:
                    continue
                px, py = px / count, py / count
                if cover == 0:
                    free = _open(depth, x, y, reach)
                cover += count
                a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
                ax, ay = screen[a, 0], screen[a, 1]
                bx, by = screen[b, 0], screen[b, 1]
                cx, cy = screen[c, 0], screen[c, 1]
                area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
                bary[0] = ((cx - bx) * (py - by) - (cy - by) * (px - bx)) / area * inverse_w[a, 0]
                bary[1] = ((ax - cx) * (py - cy) - (ay - cy) * (px - cx)) / area * inverse_w[b, 0]
                bary[2] = ((bx - ax) * (py - ay) - (by - ay) * (px - ax)) / area * inverse_w[c, 0]
                total = bary[0] + bary[1] + bary[2]
                u, v, w = bary[0] / total, bary[1] / total, bary[2] / total
                length = 0.0
                away = 0.0
                for k in range(3):
                    n[k] = u * normals[a, k] + v * normals[b, k] + w * normals[c, k]
                    p[k] = u * places[a, k] + v * places[b, k] + w * places[c, k]
                    base[k] = u * colours[a, k] + v * colours[b, k] + w * colours[c, k]
                    view[k] = eye[k] - p[k]
                    length += n[k] * n[k]
                    away += view[k] * view[k]
                length = max(np.sqrt(length), 1e-12)
                away = np.sqrt(away)
                facing = 0.0
                for k in range(3):
                    n[k] /= length
                    view[k] /= away
                    facing += n[k] * view[k]
                if area > 0.0:  # y runs down the screen: this is the triangle's back
                    facing = -facing
                    for k in range(3):
                        n[k] = -n[k]
                facing = max(facing, 0.0)
                direct = n[0] * sun[0] + n[1] * sun[1] + n[2] * sun[2]
                lit = 1.0
                if direct > 0.0:
                    lit = _lit(p, n, shadow_from, shadow, size, texel_m)
                half_x, half_y, half_z = sun[0] + view[0], sun[1] + view[1], sun[2] + view[2]
                half = np.sqrt(half_x * half_x + half_y * half_y + half_z * half_z)
                shine = max((n[0] * half_x + n[1] * half_y + n[2] * half_z) / half, 0.0)
                rough = roughness[t]
                gloss = 2.0 / (rough**4 + 1e-3)
                grazing = (1.0 - facing) ** 3
                mirror = (0.04 + 0.3 * grazing * (1.0 - rough)) * (gloss + 2.0) / 8.0
                highlight = 0.0
                if direct > 0.0 and shine > 0.5:
                    highlight = min(mirror * shine**gloss, 4.0) * direct * lit
                up = 0.5 + 0.5 * n[1]
                turned = min(max(direct * 4.0, 0.0), 1.0)
                dimmed = 1.0 - 0.8 * turned * (1.0 - lit)
                for k in range(3):
                    soft = 0.24 if k == 0 else 0.21
                    wrapped = max((direct + soft) / (1.0 + soft), 0.0)
                    ambient = lights[1, k] * up + lights[2, k] * (1.0 - up)
                    light = lights[0, k] * wrapped * dimmed * (0.5 + 0.5 * free)
                    rim = lights[3, k] * grazing * up
                    colour = base[k] * (light + free * (ambient + rim)) + lights[0, k] * highlight
                    pixel[k] += count * colour
            if channels == 3 and cover == 0:
                for k in range(3):
                    out[v0, u0, k] = bare[k]
            elif channels == 4:
                share = max(cover, 1)
                for k in range(3):
                    out[v0, u0, k] = np.uint8(_encoded(pixel[k] / share, curve) * 255.0 + 0.5)
                out[v0, u0, 3] = np.uint8(cover * 255.0 / whole + 0.5)
            else:
                left = 1.0 - cover / whole
                for k in range(3):
                    light = pixel[k] / whole + left * background[v0, k]
                    out[v0, u0, k] = np.uint8(_encoded(light, curve) * 255.0 + 0.5)
