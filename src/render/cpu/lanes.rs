//! Four points at once: every lane of a [`Vec4`] belongs to another point. Elementwise arithmetic only, so that no instruction set changes a bit.

use glam::{Vec3, Vec4};
use std::ops::{Add, Mul, Sub};

/// Four vectors, component by component.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lanes3 {
    pub x: Vec4,
    pub y: Vec4,
    pub z: Vec4,
}

impl Lanes3 {
    pub fn splat(value: Vec3) -> Self {
        Self { x: Vec4::splat(value.x), y: Vec4::splat(value.y), z: Vec4::splat(value.z) }
    }

    /// The same value in all components.
    pub fn grey(value: Vec4) -> Self {
        Self { x: value, y: value, z: value }
    }

    pub fn lane(self, lane: usize) -> Vec3 {
        Vec3::new(self.x[lane], self.y[lane], self.z[lane])
    }

    pub fn dot(self, other: Self) -> Vec4 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    pub fn length(self) -> Vec4 {
        square_root(self.dot(self))
    }

    /// Zero stays zero.
    pub fn normalize(self) -> Self {
        self * (Vec4::ONE / self.length().max(Vec4::splat(1e-30)))
    }

    pub fn max(self, other: Self) -> Self {
        Self { x: self.x.max(other.x), y: self.y.max(other.y), z: self.z.max(other.z) }
    }

    /// From `self` at 0 to `end` at 1.
    pub fn towards(self, end: Self, part: Vec4) -> Self {
        self + (end - self) * part
    }
}

impl Add for Lanes3 {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl Sub for Lanes3 {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl Mul for Lanes3 {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { x: self.x * other.x, y: self.y * other.y, z: self.z * other.z }
    }
}

impl Mul<Vec4> for Lanes3 {
    type Output = Self;

    fn mul(self, factor: Vec4) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

pub(super) fn square_root(values: Vec4) -> Vec4 {
    let [x, y, z, w] = values.to_array();
    Vec4::new(x.sqrt(), y.sqrt(), z.sqrt(), w.sqrt())
}

pub(super) fn fifth_power(x: Vec4) -> Vec4 {
    let square = x * x;
    square * square * x
}

pub(super) fn smoothstep(low: Vec4, high: Vec4, value: Vec4) -> Vec4 {
    let part = ((value - low) / (high - low)).clamp(Vec4::ZERO, Vec4::ONE);
    part * part * (Vec4::splat(3.0) - part * 2.0)
}
