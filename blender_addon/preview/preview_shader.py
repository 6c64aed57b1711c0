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

# One block of uniforms, which may be larger than push constants: (name, floats), in the order of
# memory, so that no member straddles 16 bytes (std140).
MEMBERS = (
    ("to_clip", 16),
    ("from_clip", 16),
    ("to_view_normal", 16),
    ("plane", 4),
    ("low", 3),
    ("unit", 1),
    ("per_size", 3),
    ("line_spacing", 1),
    ("cell", 3),
    ("pixel", 1),
    ("value_range", 2),
)
TYPES = {1: "float", 2: "vec2", 3: "vec3", 4: "vec4", 16: "mat4"}

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
  bool on_cut = false;
  float height = dot(part.plane.xyz, origin) + part.plane.w, rise = dot(part.plane.xyz, ray);
  if (dot(part.plane.xyz, part.plane.xyz) > 0.0) {
    // What lies above the plane is taken away.
    float crossing = -height / (abs(rise) > 1e-9 ? rise : 1e-9);
    if (rise < 0.0) {
      on_cut = crossing > t;
      t = max(t, crossing);
    } else {
      end = min(end, crossing);
    }
  }
  if (!(t < end)) discard;
  float f = field_at(origin + t * ray);
  if (f < 0.0) {
    on_cut = false;
    float reach = dot(part.cell, vec3(1.0));
    float least = 0.3 * min(part.cell.x, min(part.cell.y, part.cell.z));
    float before = t, outside = f;
    for (int i = 0; i < 1000 && f < 0.0 && t < end; ++i) {
      before = t;
      outside = f;
      t = min(t + max(-f * reach, least), end);
      f = field_at(origin + t * ray);
    }
    if (f < 0.0) discard;
    for (int i = 0; i < 4; ++i) {
      float share = clamp(outside / (outside - f), 0.05, 0.95);
      float middle = mix(before, t, share);
      float g = field_at(origin + middle * ray);
      if (g < 0.0) { before = middle; outside = g; } else { t = middle; f = g; }
    }
  }
  vec3 hit = origin + t * ray;
  vec4 seen = part.to_clip * vec4(hit, 1.0);
  vec3 color = color_at(hit);
  if (on_cut) {
    if (part.line_spacing > 0.0 && part.value_range.x >= part.value_range.y) {
      float line = line_at(hit, part.plane.xyz, part.pixel * seen.w);
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
    members = " ".join(f"{TYPES[size]} {name};" for name, size in MEMBERS)
    info.typedef_source(f"struct SardfPart {{ {members} }};")
    info.uniform_buf(0, "SardfPart", "part")
    info.sampler(0, "FLOAT_3D", "field_samples")
    info.sampler(1, "FLOAT_3D", "color_samples")
    info.define("bands", f"{BANDS}.0")
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
