//! Measures of the office: walls, rooms, core, and places for tests.

/// Half of the thickness of walls between rooms and the corridor, m. All measures of the office are sums of few powers of two: a copied
/// room is equal to the last bit. Source: ours.
pub(super) const HALF_WALL: f64 = 0.0625;

/// Outer size of a room, m. Source: ours.
pub(super) const ROOM_SIZE_M: [f64; 2] = [5.0, 4.5];

/// Middle of a room's door, from its west side, m. Source: ours.
pub(super) const DOOR_CENTRE_X_M: f64 = 3.75;

/// The closed core inside the ring: low and high corner, m. Source: ours.
pub(super) const CORE: [[f64; 2]; 2] = [[1.625, 6.125], [13.375, 12.125]];

/// South side of the northern rooms, m. Source: ours.
pub(super) const NORTH_ROOMS_Y_M: f64 = 13.75;

/// Way-points around the office's ring corridor, its centre line, m: 41.8 m around. Source: ours.
pub const OFFICE_RING: [[f64; 2]; 4] =
    [[0.84375, 5.34375], [14.15625, 5.34375], [14.15625, 12.90625], [0.84375, 12.90625]];

/// Corresponding places of the office's look-alike rooms, m: the south-west corners of two equal offices, and of two equal
/// meeting rooms.
pub const OFFICE_TWINS: [[[f64; 2]; 2]; 2] =
    [[[0.0, 0.0], [10.0, 0.0]], [[0.0, NORTH_ROOMS_Y_M], [5.0, NORTH_ROOMS_Y_M]]];
