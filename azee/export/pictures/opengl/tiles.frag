// Sums depths up in tiles, as `coarsen` in raster.py: least, mean and greatest, each tile from the
// four of the size below. The sizes lie below each other, the odd in one texture, the even in
// another.
uniform sampler2D below; // the buffer of `nearest`, or tiles
uniform bool is_first;
uniform int row;
uniform int row_below;
uniform float empty; // the depth of samples that show nothing
out vec4 tile;

vec3 depths(ivec2 at) {
    vec4 there = texelFetch(below, at, 0);
    if (!is_first) {
        return there.xyz;
    }
    return vec3(there.x > 0.0 ? there.y : empty);
}

void main() {
    ivec2 at = 2 * (ivec2(gl_FragCoord.xy) - ivec2(0, row)) + ivec2(0, row_below);
    vec3 a = depths(at);
    vec3 b = depths(at + ivec2(1, 0));
    vec3 c = depths(at + ivec2(0, 1));
    vec3 d = depths(at + ivec2(1, 1));
    tile.x = min(min(a.x, b.x), min(c.x, d.x));
    tile.y = (a.y + b.y + c.y + d.y) / 4.0;
    tile.z = max(max(a.z, b.z), max(c.z, d.z));
    tile.w = 0.0;
}
