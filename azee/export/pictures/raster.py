"""A small software rasteriser: triangles to pixels, the same on every machine.

Two passes use a z-buffer. `fill` finds the nearest triangle of every sample. `shade` lights only
visible triangles, a pixel at a time: once for each triangle in the pixel, weighted by its samples.
A second z-buffer, filled from the place of the key light, gives its soft shadow; `coarsen` sums it
up in tiles. The first z-buffer darkens creases.

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
RING = np.array([[1.0, 0.0], [0.7071, 0.7071], [0.0, 1.0], [-0.7071, 0.7071]])
"""Directions in which creases are searched, each with its opposite."""

LIGHT_RADIUS = 0.25
"""Radius of the key light, as seen from the body: of a disc at distance 1."""
STEEPEST = 3.0
SAME_M = 0.004
"""Places in a pixel that are nearer to each other than this share an answer about the light."""
DISC_TILES = 1.15
"""Radius, in tiles, of the disc that is as wide as the weights of `_bump` over tiles."""

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


@njit("void(f8[:,::1], f4[:,:,::1], i8[::1])", cache=True, nogil=True)
def coarsen(depth: Any, tiles: Any, rows: Any) -> None:
    """Fill in least, mean and greatest depth of square tiles of 2, 4, 8 … samples a side.

    Two surfaces in a tile, as at the edge of a hand, have their shares told by the three numbers.
    A fourth is the least depth in the 3 × 3 tiles around, of all sizes but the first.

    Args: depth: (S, S) as of `fill`. tiles: (·, S / 2, 4) gets one size below the other. rows: (n,)
    the first row of each size; S is a multiple of the greatest.
    """
    size = depth.shape[0]
    empty = -_FAR
    for y in range(size):
        for x in range(size):
            if depth[y, x] < _FAR:
                empty = max(empty, depth[y, x] + 1.0)
    for n in range(rows.shape[0]):
        for y in range(size >> (n + 1)):
            for x in range(size >> (n + 1)):
                least, total, most = np.float32(_FAR), np.float32(0.0), np.float32(-_FAR)
                for v in range(2 * y, 2 * y + 2):
                    for u in range(2 * x, 2 * x + 2):
                        if n == 0:
                            a = b = c = np.float32(min(depth[v, u], empty))
                        else:
                            tile = tiles[rows[n - 1] + v, u]
                            a, b, c = tile[0], tile[1], tile[2]
                        least, total, most = min(least, a), total + b, max(most, c)
                tiles[rows[n] + y, x, 0] = least
                tiles[rows[n] + y, x, 1] = total / 4
                tiles[rows[n] + y, x, 2] = most
    for n in range(1, rows.shape[0]):
        first, count = rows[n], size >> (n + 1)
        for y in range(count):
            for x in range(count):
                around = np.float32(_FAR)
                for v in range(max(0, y - 1), min(count, y + 2)):
                    for u in range(max(0, x - 1), min(count, x + 2)):
                        around = min(around, tiles[first + v, u, 0])
                tiles[first + y, x, 3] = around


@njit("f8(i8, f8)", cache=True, nogil=True)
def _bump(tile: Any, at: Any) -> Any:
    """Return the quadratic B-spline's weight of the tile before (−1), around (0) or after (1)."""
    if tile == 0:
        return 0.75 - (at - 0.5) ** 2
    return 0.5 * (1.0 - at) ** 2 if tile < 0 else 0.5 * at**2


_lit_types = "f8(f8[::1], f8[::1], f8, f8[:,::1], f4[:,:,::1], i8[::1], f8)"


@njit(_lit_types, cache=True, nogil=True)
def _lit(p: Any, n: Any, direct: Any, shadow_from: Any, tiles: Any, rows: Any, texel_m: Any) -> Any:
    """Return the share of the key light, a disc, that a place sees.

    What stands between at a height h hides as much of the light as it covers of a disc of radius
    LIGHT_RADIUS h around the place. So shadows are sharp where things touch and dissolve with their
    distance: that of a hand before the belly is no second hand. Each size of tiles takes what is at
    its heights, with weights that change smoothly with place and height, so that neither noise nor
    steps show. Shares at different heights add up. Depths are compared with the tangent plane, so
    that a surface does not shade itself. Most places have nothing between them and the light at the
    heights of a size: the least depth around tells so at once.

    Args: p, n: (3,) place and unit normal; direct: cosine between n and the light, positive.
    shadow_from, tiles, rows, texel_m: as of `shade`.
    """
    size = 2 * tiles.shape[1]
    x_at, y_at, depth = shadow_from[3, 0], shadow_from[3, 1], shadow_from[3, 2]
    along, across = 0.0, 0.0
    for k in range(3):
        raised = p[k] + 3.0 * texel_m * n[k]
        x_at += shadow_from[0, k] * raised
        y_at += shadow_from[1, k] * raised
        depth += shadow_from[2, k] * raised
        along += shadow_from[0, k] * n[k]
        across += shadow_from[1, k] * n[k]
    if x_at < 0.0 or y_at < 0.0 or x_at >= size or y_at >= size:
        return 1.0
    x_slope = texel_m * min(max(along * texel_m / direct, -STEEPEST), STEEPEST)
    y_slope = texel_m * min(max(across * texel_m / direct, -STEEPEST), STEEPEST)
    steepness = np.sqrt(x_slope**2 + y_slope**2)
    covered = 0.0
    last = rows.shape[0] - 1
    for level in range(last + 1):
        side = 2 << level
        first, count = rows[level], size >> (level + 1)
        usual = side * texel_m * DISC_TILES / LIGHT_RADIUS
        lowest = 0.0 if level == 0 else 0.5 * usual
        x0, y0 = int(x_at) >> (level + 1), int(y_at) >> (level + 1)
        u, v = x_at / side - x0, y_at / side - y0
        near = depth - 2.0 * texel_m - 0.7 * steepness * (side - 1)
        farthest = near + 1.5 * side * (abs(x_slope) + abs(y_slope)) + 1e-9
        if level > 0 and tiles[first + y0, x0, 3] >= farthest - lowest:
            continue
        for y in range(max(0, y0 - 1), min(count, y0 + 2)):
            row = near + y_slope * ((y + 0.5) * side - y_at)
            for x in range(max(0, x0 - 1), min(count, x0 + 2)):
                here = row + x_slope * ((x + 0.5) * side - x_at)
                least = tiles[first + y, x, 0]
                if least >= here - lowest:
                    continue
                height = (here - least) / usual
                if height >= 1.0:
                    share = 1.0 if level == last else max(2.0 - height, 0.0)
                else:
                    share = 1.0 if level == 0 else 2.0 * height - 1.0
                most = tiles[first + y, x, 2]
                if most > here:
                    share *= (most - tiles[first + y, x, 1]) / (most - least)
                covered += share * _bump(x - x0, u) * _bump(y - y0, v)
    return 1.0 - min(covered, 1.0)


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
            i, j = step * RING[k, 0], step * RING[k, 1]
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
def encoded(linear: Any, curve: Any) -> Any:
    """Encode linear light through a table over [0, 1], highlights rolled off towards white."""
    knee = 0.8
    if linear > knee:
        over = linear - knee
        linear = knee + (1.0 - knee) * (over / (1.0 - knee + over))
    return curve[int(max(linear, 0.0) * (curve.shape[0] - 1))]


_shade_types = (
    "void(f8[:,::1], f8[:,::1], i8[:,::1], f8[:,::1], f8[:,::1], f8[:,::1], f8[::1], f8[:,::1],"
    " i4[:,::1], f8[::1], f8, f8[::1], f8[:,::1], f8[:,::1], f4[:,:,::1], i8[::1], f8, i8,"
    " f8[:,::1], f8[::1], u1[:,:,::1])"
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
    tiles: Any,
    rows: Any,
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
    buffer, and their constants. tiles, rows: of the shadow buffer's depths in metres, as of
    `coarsen`; texel_m: metres between its samples. samples: samples per pixel, each way.
    background: (H / samples, 3) linear, by row. curve: a table of the encoding over [0, 1]. out:
    (H / samples, W / samples, 3) the picture over the background, or with 4 the light alone and its
    coverage.
    """
    height, width, channels = out.shape
    bary = np.empty(3)
    n = np.empty(3)
    p = np.empty(3)
    base = np.empty(3)
    view = np.empty(3)
    pixel = np.empty(3)
    asked = np.empty(3)
    answer = 1.0
    whole = samples * samples
    bare = np.empty(3, dtype=np.uint8)
    for v0 in range(height):
        for k in range(3):
            bare[k] = np.uint8(encoded(background[v0, k], curve) * 255.0 + 0.5)
        for u0 in range(width):
            pixel[:] = 0.0
            cover = 0
            free = 0.0
            asked[:] = _FAR
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
                    apart = 0.0
                    for k in range(3):
                        apart += (p[k] - asked[k]) ** 2
                    if apart > SAME_M**2:
                        answer = _lit(p, n, direct, shadow_from, tiles, rows, texel_m)
                        asked[:] = p
                    lit = answer
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
                    out[v0, u0, k] = np.uint8(encoded(pixel[k] / share, curve) * 255.0 + 0.5)
                out[v0, u0, 3] = np.uint8(cover * 255.0 / whole + 0.5)
            else:
                left = 1.0 - cover / whole
                for k in range(3):
                    light = pixel[k] / whole + left * background[v0, k]
                    out[v0, u0, k] = np.uint8(encoded(light, curve) * 255.0 + 0.5)
