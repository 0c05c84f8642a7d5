// The scene: backdrop and lit triangles. The shading is that of `cpu/shade.rs`, line by line, with the constants of `look.rs`.

struct Frame {
    // World to clip space, reversed depth.
    camera: mat4x4<f32>,
    eye: vec4<f32>,
    // Linear light.
    sun: vec4<f32>,
    sky: vec4<f32>,
    ground: vec4<f32>,
    // Centre of the shadow sphere, and its radius.
    shadow: vec4<f32>,
    // Unit vectors across the light, and towards it.
    across_u: vec4<f32>,
    across_v: vec4<f32>,
    towards: vec4<f32>,
    // sRGB, 0 to 1; alpha 0 for a transparent background.
    backdrop_top: vec4<f32>,
    backdrop_bottom: vec4<f32>,
    // Picture width and height, size of a shadow texel in the world, shadow texels along a side.
    size: vec4<f32>,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var shadow_map: texture_depth_2d;
@group(0) @binding(2) var shadow_sampler: sampler_comparison;

override FADE_START: f32;
override FADE_END: f32;
override SKY_IN_SHADOW: f32;
override PLAIN_MIRROR: f32;
override HORIZON: f32;
override PANEL_LOW: f32;
override PANEL_HIGH: f32;
override PANEL_BLUR: f32;
override PANEL_STRENGTH: f32;
override BIAS: f32;
override STEEPEST: f32;
// Middle, next and outermost of five symmetric filter weights.
override TAP_0: f32;
override TAP_1: f32;
override TAP_2: f32;

fn linear(srgb: vec3<f32>) -> vec3<f32> {
    return select(pow((srgb + 0.055) / 1.055, vec3<f32>(2.4)), srgb / 12.92, srgb <= vec3<f32>(0.04045));
}

fn backdrop(row: f32) -> vec3<f32> {
    return linear(mix(frame.backdrop_top.rgb, frame.backdrop_bottom.rgb, row / frame.size.y));
}

@vertex
fn backdrop_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    // One triangle that covers the picture.
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vec4<f32>(corner, 0.0, 1.0);
}

@fragment
fn backdrop_fragment(@builtin(position) place: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4<f32>(backdrop(place.y), 1.0);
}

struct Surface {
    @builtin(position) place: vec4<f32>,
    @location(0) @interpolate(perspective, centroid) position: vec3<f32>,
    @location(1) @interpolate(perspective, centroid) normal: vec3<f32>,
    @location(2) @interpolate(flat) colour: vec3<f32>,
    // Roughness, metallic, glow.
    @location(3) @interpolate(flat) finish: vec3<f32>,
}

@vertex
fn scene_vertex(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) colour: vec3<f32>,
    @location(3) finish: vec3<f32>,
) -> Surface {
    return Surface(frame.camera * vec4<f32>(position, 1.0), position, normal, colour, finish);
}

@fragment
fn scene_fragment(surface: Surface) -> @location(0) vec4<f32> {
    let behind = backdrop(surface.place.y);
    let fade = smoothstep(FADE_START, FADE_END, distance(surface.position, frame.shadow.xyz) / frame.shadow.w);
    if frame.backdrop_top.a == 0.0 {
        return before_nothing(surface, 1.0 - fade);
    }
    if fade >= 1.0 {
        return vec4<f32>(behind, 1.0);
    }
    let colour = tone_map(reflected(surface, true) + surface.colour * surface.finish.z);
    return vec4<f32>(mix(colour, behind, fade), 1.0);
}

// Light times opacity, and opacity. A surface with a glow below 0 shows its shadow alone.
fn before_nothing(surface: Surface, near: f32) -> vec4<f32> {
    let colour = tone_map(reflected(surface, true) + surface.colour * max(surface.finish.z, 0.0));
    if surface.finish.z >= 0.0 {
        return vec4<f32>(colour * near, near);
    }
    let bright = tone_map(reflected(surface, false));
    let dark = clamp(1.0 - brightness(colour) / max(brightness(bright), 1e-3), 0.0, 1.0);
    return vec4<f32>(0.0, 0.0, 0.0, dark * near);
}

// Sum of the sRGB codes of three channels of light: roots stand in for the power 1/2.4.
fn brightness(colour: vec3<f32>) -> f32 {
    let light = max(colour, vec3<f32>(0.0));
    let second = sqrt(light);
    let fourth = sqrt(second);
    let curve = second * 0.5851224 + fourth * 0.7831404 - sqrt(fourth) * 0.3682627;
    let code = select(curve, light * 12.92, light <= vec3<f32>(0.0031308));
    return code.r + code.g + code.b;
}

fn reflected(surface: Surface, with_shadows: bool) -> vec3<f32> {
    let roughness = surface.finish.x;
    let metallic = surface.finish.y;
    let normal = normalize(surface.normal);
    let view = normalize(frame.eye.xyz - surface.position);
    let facing_eye = max(dot(normal, view), 1e-3);
    let facing_sun = max(dot(normal, frame.towards.xyz), 0.0);
    let matt = surface.colour * (1.0 - metallic);
    let mirror = mix(vec3<f32>(PLAIN_MIRROR), surface.colour, metallic);
    var lit = 0.0;
    var sun = vec3<f32>(0.0);
    if facing_sun > 0.0 {
        lit = 1.0;
        if with_shadows {
            lit = lit_part(surface.position, normal, facing_sun);
        }
        let shine = highlight(normal, view, facing_eye, facing_sun, roughness, mirror);
        sun = frame.sun.rgb * (matt + shine) * (facing_sun * lit);
    }
    let diffuse = matt * hemisphere(normal.y * 0.5 + 0.5);
    let fresnel = mix(mirror, max(mirror, vec3<f32>(1.0 - roughness)), fifth_power(1.0 - facing_eye));
    let bounced = normal.y * (facing_eye * 2.0) - view.y;
    let ambient = diffuse + fresnel * surroundings(bounced, roughness);
    return sun + ambient * (SKY_IN_SHADOW + lit * (1.0 - SKY_IN_SHADOW));
}

fn highlight(
    normal: vec3<f32>,
    view: vec3<f32>,
    facing_eye: f32,
    facing_sun: f32,
    roughness: f32,
    mirror: vec3<f32>,
) -> vec3<f32> {
    let middle = normalize(view + frame.towards.xyz);
    let alpha = roughness * roughness;
    let across = max(dot(normal, middle), 0.0);
    let spread = across * across * (alpha * alpha - 1.0) + 1.0;
    let both = facing_eye * facing_sun * 2.0;
    let masking = both + (facing_eye + facing_sun - both) * alpha;
    let strength = alpha * alpha * 0.5 / (spread * spread * masking);
    return mix(mirror, vec3<f32>(1.0), fifth_power(1.0 - max(dot(view, middle), 0.0))) * strength;
}

fn hemisphere(up: f32) -> vec3<f32> {
    return mix(frame.ground.rgb, frame.sky.rgb, up);
}

fn surroundings(up: f32, roughness: f32) -> vec3<f32> {
    let soft = HORIZON + roughness * (1.0 - HORIZON);
    let panel = smoothstep(PANEL_LOW - roughness * PANEL_BLUR, PANEL_HIGH + roughness * PANEL_BLUR, up);
    return hemisphere(smoothstep(-soft, soft, up)) + frame.sky.rgb * (panel * PANEL_STRENGTH);
}

fn tap(index: i32) -> f32 {
    return select(select(TAP_2, TAP_1, abs(index) == 1), TAP_0, index == 0);
}

// Part of the sun's light, 0 to 1, that reaches a surface with the given unit normal.
fn lit_part(position: vec3<f32>, normal: vec3<f32>, facing: f32) -> f32 {
    let texel = frame.size.z;
    let side = frame.size.w;
    let from_centre = position - frame.shadow.xyz;
    let across = vec2<f32>(dot(from_centre, frame.across_u.xyz), dot(from_centre, frame.across_v.xyz));
    let place = (across + frame.shadow.w) / texel;
    let tilt = vec2<f32>(dot(normal, frame.across_u.xyz), dot(normal, frame.across_v.xyz));
    let slope = clamp(-tilt / max(facing, 1e-3), vec2<f32>(-STEEPEST), vec2<f32>(STEEPEST)) * texel;
    let height = dot(from_centre, frame.towards.xyz) + (abs(slope.x) + abs(slope.y) + texel) * BIAS;
    if min(place.x, place.y) < 2.5 || max(place.x, place.y) >= side - 5.5 {
        return 1.0;
    }
    var lit = 0.0;
    for (var row = -2; row <= 2; row++) {
        for (var column = -2; column <= 2; column++) {
            let offset = vec2<f32>(f32(column), f32(row));
            let depth = 0.5 + (height + dot(slope, offset)) / (8.0 * frame.shadow.w);
            let seen = textureSampleCompareLevel(shadow_map, shadow_sampler, (place + offset) / side, depth);
            lit += seen * tap(column) * tap(row);
        }
    }
    return lit;
}

fn fifth_power(x: f32) -> f32 {
    let square = x * x;
    return square * square * x;
}

// Khronos PBR neutral tone mapper.
fn tone_map(light: vec3<f32>) -> vec3<f32> {
    let start = 0.8 - 0.04;
    let room = 1.0 - start;
    let least = min(light.r, min(light.g, light.b));
    let colour = light - select(0.04, least - 6.25 * least * least, least < 0.08);
    let peak = max(colour.r, max(colour.g, colour.b));
    if peak < start {
        return colour;
    }
    let rolled = 1.0 - room * room / (peak + room - start);
    let fade = 1.0 - 1.0 / (0.15 * (peak - rolled) + 1.0);
    return mix(colour * (rolled / peak), vec3<f32>(rolled), fade);
}
