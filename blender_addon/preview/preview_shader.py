# SPDX-License-Identifier: GPL-3.0-or-later
"""The one shader of the preview: it marches through a part's samples, whatever the part is.

Coordinates are the part's own (scene units); the field's unit and how far a step may go are those
of preview_volume.Volume.
"""

import gpu
import numpy as np

# Coefficients of 1, t, t², ... for red, green and blue (sRGB): a fit of degree 6 to the colour map
# viridis of matplotlib (CC0), 0.017 off at most. The legend draws the same.
COLOR_MAP = (
    (0.2745, 0.1077, -0.3272, -4.5999, 6.2037, 4.7518, -5.4321),
    (0.0058, 1.3965, 0.2148, -5.7582, 14.154, -13.7494, 4.6416),
    (0.3327, 1.3868, 0.092, -19.2918, 56.6563, -65.321, 26.2721),
)
BANDS = 10  # of a colour bar with stripes
MOST_CUTS, MOST_PLANES = 8, 8  # what is cut away, and how many planes bound each of it at most
NO_PLANE = (0.0, 0.0, 0.0, 1.0)  # everything lies above it

# One block of uniforms, which may be larger than push constants: (name, floats), in the order of
# memory, so that no member straddles 16 bytes (std140).
MEMBERS = (
    ("to_clip", 16),
    ("from_clip", 16),
    ("to_view_normal", 16),
    ("cuts", 4 * MOST_CUTS * MOST_PLANES),
    ("low", 3),
    ("unit", 1),
    ("per_size", 3),
    ("line_spacing", 1),
    ("cell", 3),
    ("pixel", 1),
    ("value_range", 2),
    ("cut_count", 1),
)
TYPES = {1: "float", 2: "vec2", 3: "vec3", 16: "mat4"}

VERTEX = """
void main() {
  clip = part.to_clip * vec4(position, 1.0);
  gl_Position = clip;
}
"""

FRAGMENT = """
vec3 place(vec3 p) { return (p - part.low) * part.per_size; }
float field_at(vec3 p) { return texture(field_samples, place(p)).r; }

// Inside to outside, not of unit length.
vec3 outward(vec3 p) {
  vec3 h = 0.7 * part.cell;
  return -vec3(
    (field_at(p + vec3(h.x, 0, 0)) - field_at(p - vec3(h.x, 0, 0))) / h.x,
    (field_at(p + vec3(0, h.y, 0)) - field_at(p - vec3(0, h.y, 0))) / h.y,
    (field_at(p + vec3(0, 0, h.z)) - field_at(p - vec3(0, 0, h.z))) / h.z);
}

vec3 to_linear(vec3 c) {
  return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, vec3(lessThan(c, vec3(0.04045))));
}

// The material's colour, linear, or the colour map's where one number is shown.
vec3 color_at(vec3 p) {
  vec4 sampled = texture(color_samples, place(p));
  if (sampled.a < 1e-3) return vec3(0.5);
  vec3 color = sampled.rgb / sampled.a;
  if (part.value_range.x >= part.value_range.y) return color;
  vec2 span = part.value_range;
  float t = clamp((color.r - span.x) / (span.y - span.x), 0.0, 1.0);
  if (part.line_spacing > 0.0) t = (floor(min(t, 0.9999) * bands) + 0.5) / bands;
  vec3 map = vec3(COLOR_MAP_RED, COLOR_MAP_GREEN, COLOR_MAP_BLUE);
  return to_linear(clamp(map, 0.0, 1.0));
}

// How much of an iso-line of the distance covers a pixel of this size, on a cut.
float line_at(vec3 p, vec3 normal, float pixel) {
  vec3 along = outward(p);
  along -= normal * (dot(along, normal) / dot(normal, normal));
  float steep = max(length(along), 1e-6);
  float lines = part.line_spacing / part.unit;  // in the field's unit
  float f = field_at(p) / lines;
  float away = abs(f - floor(f + 0.5)) * lines / steep;  // scene units, half a pixel wide lines
  return 1.0 - smoothstep(0.5 * pixel, 1.5 * pixel, away);
}

float lit(vec3 normal) {
  // From above left, from the right, and from the eye, in view coordinates.
  float key = max(dot(normal, normalize(vec3(-0.35, 0.6, 0.7))), 0.0);
  float fill = max(dot(normal, normalize(vec3(0.8, -0.1, 0.4))), 0.0);
  return 0.22 + 0.62 * key + 0.16 * fill + 0.1 * max(normal.z, 0.0);
}

// Of what each cut takes away, where the ray enters and leaves it, and by which plane it leaves.
float enter_cut[most_cuts], leave_cut[most_cuts];
vec3 leave_normal[most_cuts];

void meet_cuts(vec3 origin, vec3 ray) {
  for (int c = 0; c < int(part.cut_count); ++c) {
    float from = -1e30, to = 1e30;
    leave_normal[c] = vec3(0.0, 0.0, 1.0);
    for (int k = 0; k < most_planes; ++k) {
      vec4 plane = part.cuts[c * most_planes + k];
      float height = dot(plane.xyz, origin) + plane.w, rise = dot(plane.xyz, ray);
      if (rise == 0.0) {
        if (height <= 0.0) to = -1e30;
      } else if (rise > 0.0) {
        from = max(from, -height / rise);
      } else if (-height / rise < to) {
        to = -height / rise;
        leave_normal[c] = plane.xyz;
      }
    }
    enter_cut[c] = from;
    leave_cut[c] = to;
  }
}

// Where the ray goes on from t: behind all cuts that t lies in. `normal`: of the last one's plane.
float behind_cuts(float t, float slack, inout vec3 normal) {
  for (int again = 0; again < int(part.cut_count); ++again) {
    for (int c = 0; c < int(part.cut_count); ++c) {
      if (enter_cut[c] - slack <= t && t < leave_cut[c]) {
        t = leave_cut[c];
        normal = leave_normal[c];
      }
    }
  }
  return t;
}

float next_cut(float t, float end) {
  for (int c = 0; c < int(part.cut_count); ++c) {
    if (enter_cut[c] > t && enter_cut[c] < leave_cut[c]) end = min(end, enter_cut[c]);
  }
  return end;
}

// The first point of the solid on the ray from t on, but before `stop`, where it ends otherwise.
bool reach_surface(vec3 origin, vec3 ray, inout float t, float stop) {
  float f = field_at(origin + t * ray);
  float reach = dot(part.cell, vec3(1.0));
  float least = 0.3 * min(part.cell.x, min(part.cell.y, part.cell.z));
  float before = t, outside = f;
  for (int i = 0; i < 1000 && f < 0.0 && t < stop; ++i) {
    before = t;
    outside = f;
    t = min(t + max(-f * reach, least), stop);
    f = field_at(origin + t * ray);
  }
  if (f < 0.0) return false;
  for (int i = 0; i < 4; ++i) {
    float share = clamp(outside / (outside - f), 0.05, 0.95);
    float middle = mix(before, t, share);
    float g = field_at(origin + middle * ray);
    if (g < 0.0) { before = middle; outside = g; } else { t = middle; f = g; }
  }
  return true;
}

void main() {
  vec2 at = clip.xy / clip.w;
  vec4 front = part.from_clip * vec4(at, -1.0, 1.0), back = part.from_clip * vec4(at, 1.0, 1.0);
  vec3 origin = front.xyz / front.w;
  vec3 ray = normalize(back.xyz / back.w - origin);
  ray += vec3(lessThan(abs(ray), vec3(1e-7))) * 1e-7;
  vec3 a = (part.low - origin) / ray, b = (part.low + 1.0 / part.per_size - origin) / ray;
  vec3 enter = min(a, b), leave = max(a, b);
  float t = max(max(enter.x, enter.y), max(enter.z, 0.0));
  float end = min(leave.x, min(leave.y, leave.z));
  bool is_found = false, on_cut = false;
  vec3 cut_normal = vec3(0.0);
  float slack = 1e-3 * min(part.cell.x, min(part.cell.y, part.cell.z));
  meet_cuts(origin, ray);
  // Each turn goes through what the cuts leave up to the next of them.
  for (int turn = 0; turn <= most_cuts && !is_found; ++turn) {
    float begin = t;
    t = behind_cuts(t, slack, cut_normal);
    if (!(t < end)) discard;
    on_cut = t > begin && field_at(origin + t * ray) >= 0.0;
    is_found = on_cut || field_at(origin + t * ray) >= 0.0;
    if (!is_found) is_found = reach_surface(origin, ray, t, next_cut(t, end));
  }
  if (!is_found) discard;
  vec3 hit = origin + t * ray;
  vec4 seen = part.to_clip * vec4(hit, 1.0);
  vec3 color = color_at(hit);
  if (on_cut) {
    if (part.line_spacing > 0.0 && part.value_range.x >= part.value_range.y) {
      float line = line_at(hit, cut_normal, part.pixel * seen.w);
      color = mix(color, vec3(dot(color, vec3(0.333)) > 0.05 ? 0.0 : 0.6), 0.75 * line);
    }
  } else {
    vec3 normal = normalize((part.to_view_normal * vec4(outward(hit), 0.0)).xyz);
    color *= lit(normal.z < 0.0 ? normal - 2.0 * normal.z * vec3(0, 0, 1) : normal);
  }
  gl_FragDepth = 0.5 + 0.5 * seen.z / seen.w;
  out_color = vec4(color, 1.0);
}
"""


def _polynomial(coefficients):
    text = str(coefficients[-1])
    for coefficient in reversed(coefficients[:-1]):
        text = f"{coefficient} + t * ({text})"
    return text


def map_color(t):
    """The colour map's sRGB colour at t in [0, 1]."""
    return tuple(
        min(max(sum(c * t**n for n, c in enumerate(channel)), 0.0), 1.0) for channel in COLOR_MAP
    )


def planes_of(cuts):
    """The planes of all cuts, with NO_PLANE where there are none."""
    planes = [NO_PLANE] * (MOST_CUTS * MOST_PLANES)
    for number, cut in enumerate(cuts):
        first = number * MOST_PLANES
        planes[first : first + len(cut)] = cut
    return planes


def _declared(name, size):
    if name == "cuts":
        return f"vec4 cuts[{size // 4}];"
    return f"{TYPES[size]} {name};"


def block(values):
    """The uniforms {name: floats, matrices by columns} as a buffer of the graphics card."""
    numbers = [float(number) for name, _ in MEMBERS for number in np.ravel(values[name])]
    numbers += [0.0] * (-len(numbers) % 4)
    return gpu.types.GPUUniformBuf(np.array(numbers, np.float32))


def create():
    """The compiled shader. Raises whatever Blender raises where it has no GPU."""
    between = gpu.types.GPUStageInterfaceInfo("sardf_preview")
    between.smooth("VEC4", "clip")
    info = gpu.types.GPUShaderCreateInfo()
    members = " ".join(_declared(name, size) for name, size in MEMBERS)
    info.typedef_source(f"struct SardfPart {{ {members} }};")
    info.uniform_buf(0, "SardfPart", "part")
    info.sampler(0, "FLOAT_3D", "field_samples")
    info.sampler(1, "FLOAT_3D", "color_samples")
    info.define("bands", f"{BANDS}.0")
    info.define("most_cuts", str(MOST_CUTS))
    info.define("most_planes", str(MOST_PLANES))
    for name, coefficients in zip(("RED", "GREEN", "BLUE"), COLOR_MAP, strict=True):
        info.define(f"COLOR_MAP_{name}", f"({_polynomial(coefficients)})")
    info.vertex_in(0, "VEC3", "position")
    info.vertex_out(between)
    info.fragment_out(0, "VEC4", "out_color")
    if hasattr(info, "depth_write"):  # Blender 4.4 and later want to be told
        info.depth_write("ANY")
    info.vertex_source(VERTEX)
    info.fragment_source(FRAGMENT)
    return gpu.shader.create_from_info(info)
