// The shadow map: height towards the light as depth, greatest where nearest to the light.

struct Light {
    // Centre of the shadow sphere, and its radius.
    shadow: vec4<f32>,
    // Unit vectors across the light, and towards it.
    across_u: vec4<f32>,
    across_v: vec4<f32>,
    towards: vec4<f32>,
}

@group(0) @binding(0) var<uniform> light: Light;

@vertex
fn shadow_vertex(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> {
    let from_centre = (position - light.shadow.xyz) / light.shadow.w;
    let across = vec2<f32>(dot(from_centre, light.across_u.xyz), dot(from_centre, light.across_v.xyz));
    let height = dot(from_centre, light.towards.xyz);
    // Rows of a texture run downwards.
    return vec4<f32>(across.x, -across.y, 0.5 + height / 8.0, 1.0);
}
