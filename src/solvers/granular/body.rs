//! The data of a body besides its pebbles.

use bytemuck::{Pod, Zeroable, must_cast_mut, must_cast_ref};
use serde::{Deserialize, Serialize};

/// Number of a body in the order of creation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct BodyId(pub u32);

/// The part of the state of a body that its contacts do not read. Its first eight numbers are what a step reads of all
/// bodies: they are loaded as one row, see [`Body::row`].
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable, Serialize, Deserialize)]
pub(super) struct Body {
    /// At half steps \[m/s\].
    pub velocity: [f64; 3],
    /// Angular velocity of a sphere at half steps \[rad/s\]; of a clump, angular momentum \[kg m2/s\].
    pub spin: [f64; 3],
    /// Inverse of its inertia \[1/kg\]; 0 for a body that keeps its velocity.
    pub inverse_mass: f64,
    /// Inverse moment of inertia of a sphere \[1/(kg m2)\].
    pub inverse_inertia: f64,
    /// Mass that has weight, without the mass added by mass scaling \[kg\].
    pub mass: f64,
    /// Cell of the domain, not wrapped.
    pub cell: [i32; 3],
    /// Number in the order of creation.
    pub id: u32,
    /// Number of the body in its bay: the same for its copies in other bays.
    pub rank: u32,
    /// First pebble, in the order of the bed.
    pub first: u32,
    pub pebbles: u16,
    pub surface: u16,
    /// Index in the clumps of the bed, `u32::MAX` for a sphere.
    pub clump: u32,
}

pub(super) const SPHERE: u32 = u32::MAX;

impl Body {
    /// Velocity, spin, inverse mass and inverse moment of inertia.
    #[inline(always)]
    pub fn row(&self) -> &[f64; 8] {
        let words: &[f64; 13] = must_cast_ref(self);
        words.first_chunk().expect("thirteen words")
    }

    #[inline(always)]
    pub fn row_mut(&mut self) -> &mut [f64; 8] {
        let words: &mut [f64; 13] = must_cast_mut(self);
        words.first_chunk_mut().expect("thirteen words")
    }
}

/// Position of a pebble in the frame of its body \[m\]; the fourth number is 0, so that it is loaded as one row.
pub(super) type Arm = [f64; 4];

/// The data of a clump in addition to those of a sphere.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable, Serialize, Deserialize)]
pub(super) struct Clump {
    /// Offset of the centroid in the cell of the body \[m\].
    pub centre: [f64; 3],
    /// Unit quaternion w, x, y, z: body frame to world.
    pub attitude: [f64; 4],
    /// Angular velocity of the last half step \[rad/s\].
    pub turning: [f64; 3],
    /// Inverse principal moments of inertia \[1/(kg m2)\].
    pub inverse_inertia: [f64; 3],
    /// Index of the first pebble position in the body frame.
    pub arms: u64,
}

/// Words of a clump that are loaded as the second row; three of them are in the first row too.
const BACK: usize = 5;

impl Clump {
    /// Centre, attitude, and the first of [`Clump::turning`].
    #[inline(always)]
    pub fn front(&self) -> &[f64; 8] {
        let words: &[f64; 14] = must_cast_ref(self);
        words.first_chunk().expect("fourteen words")
    }

    /// The last two of the attitude, turning, inverse moments of inertia.
    #[inline(always)]
    pub fn back(&self) -> &[f64; 8] {
        let words: &[f64; 14] = must_cast_ref(self);
        words[BACK..].first_chunk().expect("nine words")
    }

    /// Overwrites both rows; they agree where they overlap.
    #[inline(always)]
    pub fn set_rows(&mut self, front: &[f64; 8], back: &[f64; 8]) {
        let words: &mut [f64; 14] = must_cast_mut(self);
        words[..8].copy_from_slice(front);
        words[BACK..BACK + 8].copy_from_slice(back);
    }
}
