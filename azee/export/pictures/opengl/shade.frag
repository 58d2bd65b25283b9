// Lights what a pixel shows and encodes it, as `shade` in raster.py, which explains how and why:
// a triangle once a pixel, at the mean of its samples, weighted by their number. A change of the
// formulas there is one of these, too.
uniform sampler2D seen; // of the samples: triangle, counted from 1, and -1 / distance
uniform isampler2D triangles; // three vertices, and the bits of the roughness
uniform sampler2D places; // of vertices: the place, and x in samples
uniform sampler2D normals; // the normal, and y in samples
uniform sampler2D colours;
uniform sampler2D even_tiles;
uniform sampler2D odd_tiles;
uniform vec3 eye;
uniform vec3 back; // the unit direction of the view, towards the eye
uniform float reach; // samples a metre at distance 1
uniform vec3 sun;
uniform vec3 key;
uniform vec3 sky;
uniform vec3 ground;
uniform vec3 rim;
uniform vec3 shadow_x; // a place in the view from the key light: samples, and metres of depth
uniform vec3 shadow_y;
uniform vec3 shadow_depth;
uniform vec3 shadow_constant;
uniform float texel_m;
uniform vec3 top;
uniform vec3 bottom;
uniform int rows;
uniform bool transparent;
out vec4 pixel;

const float FAR = 1e30;
const int WHOLE = SAMPLES * SAMPLES;
const vec2 RING[4] = vec2[](vec2(1.0, 0.0), vec2(0.7071, 0.7071), vec2(0.0, 1.0), vec2(-0.7071, 0.7071));

ivec2 texel(int number) {
    return ivec2(number % COLUMNS, number / COLUMNS);
}

vec4 tile(int level, int row, ivec2 at) {
    at.y += row;
    return (level & 1) == 0 ? texelFetch(even_tiles, at, 0) : texelFetch(odd_tiles, at, 0);
}

// The least depth in the 3 x 3 tiles around: it is in the texture that has no tiles of this size.
float around(int level, int row, ivec2 at) {
    return tile(level + 1, row, at).x;
}

// The weight of the tile before (-1), around (0) or after (1).
float bump(int tile, float at) {
    if (tile == 0) {
        return 0.75 - (at - 0.5) * (at - 0.5);
    }
    return tile < 0 ? 0.5 * (1.0 - at) * (1.0 - at) : 0.5 * at * at;
}

// The share of the key light that a place sees.
float lit(vec3 p, vec3 n, float direct) {
    vec3 raised = p + 3.0 * texel_m * n;
    vec2 at = vec2(dot(shadow_x, raised), dot(shadow_y, raised)) + shadow_constant.xy;
    float depth = dot(shadow_depth, raised) + shadow_constant.z;
    if (at.x < 0.0 || at.y < 0.0 || at.x >= float(SHADOW) || at.y >= float(SHADOW)) {
        return 1.0;
    }
    vec2 along = vec2(dot(shadow_x, n), dot(shadow_y, n));
    vec2 slope = texel_m * clamp(along * texel_m / direct, -STEEPEST, STEEPEST);
    float steepness = length(slope);
    float covered = 0.0;
    int row = 0;
    for (int level = 0; level < LEVELS; ++level) {
        float side = float(2 << level);
        int count = SHADOW >> (level + 1);
        float usual = side * texel_m * DISC_TILES / LIGHT_RADIUS;
        float lowest = level == 0 ? 0.0 : 0.5 * usual;
        ivec2 middle = ivec2(at) >> (level + 1);
        vec2 inside = at / side - vec2(middle);
        float near = depth - 2.0 * texel_m - 0.7 * steepness * (side - 1.0);
        float farthest = near + 1.5 * side * (abs(slope.x) + abs(slope.y)) + 1e-6;
        if (level > 0 && around(level, row, middle) >= farthest - lowest) {
            row += count;
            continue;
        }
        ivec2 first = max(middle - 1, 0);
        ivec2 last = min(middle + 1, count - 1);
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) {
                vec2 away = (vec2(x, y) + 0.5) * side - at;
                float here = near + dot(slope, away);
                vec4 found = tile(level, row, ivec2(x, y));
                if (found.x >= here - lowest) {
                    continue;
                }
                float height = (here - found.x) / usual;
                float share;
                if (height >= 1.0) {
                    share = level == LEVELS - 1 ? 1.0 : max(2.0 - height, 0.0);
                } else {
                    share = level == 0 ? 1.0 : 2.0 * height - 1.0;
                }
                if (found.z > here) {
                    share *= (found.z - found.y) / (found.z - found.x);
                }
                covered += share * bump(x - middle.x, inside.x) * bump(y - middle.y, inside.y);
            }
        }
        row += count;
    }
    return 1.0 - min(covered, 1.0);
}

// The share of the surroundings that a sample sees.
float open(ivec2 at) {
    ivec2 last = textureSize(seen, 0) - 1;
    float here = -1.0 / texelFetch(seen, at, 0).y;
    float covered = 0.0;
    for (int ring = 0; ring < 2; ++ring) {
        float radius_m = 0.02 + 0.03 * float(ring);
        float far = radius_m * reach / here;
        for (int k = 0; k < 4; ++k) {
            float both = 0.0;
            for (int side = -1; side < 2; side += 2) {
                ivec2 there = clamp(ivec2(vec2(at) + float(side) * far * RING[k]), ivec2(0), last);
                vec2 found = texelFetch(seen, there, 0).xy;
                float ahead = found.x == 0.0 ? -radius_m : here + 1.0 / found.y;
                if (ahead > 2.0 * radius_m) {
                    ahead = 0.0;
                }
                both += clamp(ahead, -radius_m, radius_m) / radius_m;
            }
            covered += max(both, 0.0);
        }
    }
    return 1.0 - 0.6 * min(covered / 8.0, 1.0);
}

// sRGB (IEC 61966-2-1) by the steps of the rasteriser's table, highlights rolled off.
vec3 encoded(vec3 linear) {
    vec3 over = max(linear - 0.8, 0.0);
    vec3 rolled = min(linear, 0.8) + 0.2 * (over / (0.2 + over));
    vec3 steps = floor(max(rolled, 0.0) * 4096.0) / 4096.0;
    vec3 curve = mix(
        1.055 * pow(steps, vec3(1.0 / 2.4)) - 0.055, 12.92 * steps, lessThanEqual(steps, vec3(0.0031308))
    );
    return floor(curve * 255.0 + 0.5) / 255.0;
}

// What one triangle shows at a place on the screen, in samples. `asked` is the last place whose
// shadow was looked up, and `answer` what was found.
vec3 light(int triangle, vec2 at, float free, inout vec3 asked, inout float answer) {
    ivec4 corners = texelFetch(triangles, texel(triangle), 0);
    ivec2 a = texel(corners.x), b = texel(corners.y), c = texel(corners.z);
    vec4 place_a = texelFetch(places, a, 0), normal_a = texelFetch(normals, a, 0);
    vec4 place_b = texelFetch(places, b, 0), normal_b = texelFetch(normals, b, 0);
    vec4 place_c = texelFetch(places, c, 0), normal_c = texelFetch(normals, c, 0);
    vec2 to_a = vec2(place_a.w, normal_a.w) - at;
    vec2 to_b = vec2(place_b.w, normal_b.w) - at;
    vec2 to_c = vec2(place_c.w, normal_c.w) - at;
    vec3 areas = vec3(
        to_b.x * to_c.y - to_b.y * to_c.x,
        to_c.x * to_a.y - to_c.y * to_a.x,
        to_a.x * to_b.y - to_a.y * to_b.x
    );
    float area = areas.x + areas.y + areas.z;
    vec3 weights = areas / area / vec3(
        dot(eye - place_a.xyz, back), dot(eye - place_b.xyz, back), dot(eye - place_c.xyz, back)
    );
    weights /= weights.x + weights.y + weights.z;
    vec3 p = weights.x * place_a.xyz + weights.y * place_b.xyz + weights.z * place_c.xyz;
    vec3 n = weights.x * normal_a.xyz + weights.y * normal_b.xyz + weights.z * normal_c.xyz;
    vec3 base = weights.x * texelFetch(colours, a, 0).rgb + weights.y * texelFetch(colours, b, 0).rgb
        + weights.z * texelFetch(colours, c, 0).rgb;
    n /= max(length(n), 1e-12);
    if (area > 0.0) { // y runs down the screen: this is the triangle's back
        n = -n;
    }
    vec3 view = normalize(eye - p);
    float facing = max(dot(n, view), 0.0);
    float direct = dot(n, sun);
    float lit_share = 1.0;
    if (direct > 0.0) {
        vec3 apart = p - asked;
        if (dot(apart, apart) > SAME_M * SAME_M) {
            answer = lit(p, n, direct);
            asked = p;
        }
        lit_share = answer;
    }
    vec3 half_way = sun + view;
    float shine = max(dot(n, half_way) / length(half_way), 0.0);
    float rough = intBitsToFloat(corners.w);
    float gloss = 2.0 / (rough * rough * rough * rough + 1e-3);
    float grazing = (1.0 - facing) * (1.0 - facing) * (1.0 - facing);
    float mirror = (0.04 + 0.3 * grazing * (1.0 - rough)) * (gloss + 2.0) / 8.0;
    float highlight = 0.0;
    if (direct > 0.0 && shine > 0.5) {
        highlight = min(mirror * pow(shine, gloss), 4.0) * direct * lit_share;
    }
    float up = 0.5 + 0.5 * n.y;
    float turned = clamp(direct * 4.0, 0.0, 1.0);
    float dimmed = 1.0 - 0.8 * turned * (1.0 - lit_share);
    vec3 soft = vec3(0.24, 0.21, 0.21);
    vec3 wrapped = max((direct + soft) / (1.0 + soft), 0.0);
    vec3 ambient = sky * up + ground * (1.0 - up) + rim * grazing * up;
    vec3 sunny = key * wrapped * dimmed * (0.5 + 0.5 * free);
    return base * (sunny + free * ambient) + key * highlight;
}

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * SAMPLES;
    int shown[WHOLE];
    int cover = 0;
    for (int k = 0; k < WHOLE; ++k) {
        shown[k] = int(texelFetch(seen, corner + ivec2(k % SAMPLES, k / SAMPLES), 0).x) - 1;
        cover += shown[k] < 0 ? 0 : 1;
    }
    float row = floor(gl_FragCoord.y) / float(max(rows - 1, 1));
    vec3 background = top + row * (bottom - top);
    vec3 sum = vec3(0.0);
    float free = 1.0;
    vec3 asked = vec3(FAR);
    float answer = 1.0;
    for (int left = cover; left > 0;) { // a triangle a round: its samples are done with then
        int triangle = -1;
        int first = 0;
        int count = 0;
        vec2 at = vec2(0.0);
        for (int k = 0; k < WHOLE; ++k) {
            if (triangle < 0 && shown[k] >= 0) {
                triangle = shown[k];
                first = k;
            }
            if (triangle >= 0 && shown[k] == triangle) {
                shown[k] = -1;
                count += 1;
                at += vec2(corner + ivec2(k % SAMPLES, k / SAMPLES)) + 0.5;
            }
        }
        if (left == cover) {
            free = open(corner + ivec2(first % SAMPLES, first / SAMPLES));
        }
        sum += float(count) * light(triangle, at / float(count), free, asked, answer);
        left -= count;
    }
    if (transparent) {
        float alpha = floor(float(cover) * 255.0 / float(WHOLE) + 0.5) / 255.0;
        pixel = vec4(encoded(sum / float(max(cover, 1))), alpha);
    } else {
        float left = 1.0 - float(cover) / float(WHOLE);
        pixel = vec4(encoded(sum / float(WHOLE) + left * background), 1.0);
    }
}
