//! Every number of the engine that no table sets: with its unit, its reason, and what breaks when it changes.

/// Version of the physics. A change that alters any trajectory must raise it, since scores, replays and golden digests
/// are only valid for the version that they were made with.
pub const PHYSICS_VERSION: u32 = 3;

/// Share of a tangential force that accelerates a solid sphere which rolls along a surface: 1 / (1 + 2/5), no unit.
/// The rest goes into its spin.
pub const ROLLING_SHARE: f64 = 5.0 / 7.0;

/// Share of the slip that friction removes before a solid sphere rolls: 2/7, no unit (Cross 2002).
pub const SLIP_SHARE: f64 = 2.0 / 7.0;

/// Moment of inertia of a solid sphere in units of m r^2.
pub const SPHERE_INERTIA: f64 = 2.0 / 5.0;

/// A ball closer to a surface than this share of the largest coordinate involved touches it. About 250 roundings of an
/// f64: an impact leaves the ball a few roundings off the surface. Smaller: a ball sees its last impact again.
/// Larger: a real gap of that size is taken for contact.
pub const TOUCH: f64 = 1.0 / (1_u64 << 44) as f64;

/// An approach slower than this share of the ball's speed (or a pull weaker than this share of its acceleration) is no
/// approach but rounding. Smaller: a ball that slides along a surface hits it over and over at the same instant.
pub const GRAZE: f64 = 1.0 / (1_u64 << 46) as f64;

/// How deep inside a surface, in ball radii, a ball still counts as touching it rather than as being on its other
/// side. Moving flippers and arcs followed tick by tick leave overlaps of some micrometres. Smaller: such a ball falls
/// through. Larger: a ball that passes a gate from behind is caught by it.
pub const DEEPEST_OVERLAP: f64 = 0.5;

/// Longest part of a flight that is searched, seconds: 30,000 years. Beyond, a subnormal speed makes times infinite.
pub const LONGEST_FLIGHT: f64 = 1e12;

/// Share of a circle's reach by which the square around it is larger: more than the rounding of the times at which a
/// flight enters and leaves it. Smaller: a graze right at the square's side is missed. Larger: only cost.
pub const NEAR_MARGIN: f64 = 1e-9;

/// Share of a ball's radius, and of a shape's coordinates, by which the box around a shape is larger than it must be. They
/// cover the rounding of a flight's own box. Smaller: an impact at a box's very side is not looked for. Larger: only cost.
pub const BOUNDS_MARGIN: f64 = 1e-6;
/// See [`BOUNDS_MARGIN`].
pub const BOUNDS_ROUNDING: f64 = 1e-12;

/// Searches within one tick that are taken up where the one before ended. A ball that flies farther in a tick than so many
/// searches go, through a grid of many cells with nothing in them, would not be seen beyond.
pub const MOST_SEARCHES_PER_TICK: u32 = 64;

/// Fastest ball, m/s. Beyond, squares of speeds and of ways overflow. What is faster is cut to it, or refused.
pub const MOST_SPEED: f64 = 1e13;

/// Pieces of a flight, each about a cell of the broad phase long, that one search goes through before it says how far it
/// came.
pub const MOST_PIECES: u32 = 4096;

/// Parts into which the pixel model cuts a tick at the most: beyond, a step is longer than a pixel.
pub const MOST_PARTS_PER_TICK: u32 = 1_000_000;

/// Steps of Newton's method on a convex polynomial. About six reach a simple root, thirty a double one; the rest is for
/// brackets of many decades.
pub const MOST_NEWTON_STEPS: u32 = 100;

/// Parts of a tick into which the search for an impact with a moving flipper divides it at the least. At 20 m/s and
/// 1 kHz a part is 0.3 mm: a graze shallower than a micrometre can be missed, a crossing cannot.
pub const MOVER_PARTS: u32 = 64;

/// Halvings by which an impact with a moving flipper is located within such a part: 1 ms / 64 / 2^40 is 1e-17 s.
pub const MOVER_HALVINGS: u32 = 40;

/// Impacts of one ball within one tick after which it is taken to lie still for the rest of that tick. Infinitely many
/// impacts in finite time (a ball in a V) end here if it has not come to rest before. Smaller: a ball that rattles between
/// two posts is stopped. Larger: such a ball costs more.
pub const MOST_IMPACTS_PER_TICK: u32 = 200;

/// The same for long ticks: impacts a second, as many as that in a tick of a millisecond.
pub const MOST_IMPACTS_PER_SECOND: f64 = 2e5;

/// Angular speed, rad/s, below which a flipper that reaches an end stop stays there.
pub const FLIPPER_STOP_SPEED: f64 = 1.0;

/// Fastest that a hinged plate turns, rad/s: 1600 turns a second, 80 times what a machine's spinner does. Every half turn is
/// an event. Larger: a tick may have so many of them that it never ends.
pub const MOST_HINGE_SPEED: f64 = 1e4;

/// Share of what gravity does for a ball at a plate that lifting the plate may take at the most: less than all of it, so that no
/// rounding lets a ball lie on the plate. Smaller: plates that would open are refused.
pub const MOST_LIFT: f64 = 0.9;

/// Share of gravity across a plate's line below which a ball is not pressed against it: rounding of the line's direction.
/// Smaller: a plate along the pull of gravity is refused for it.
pub const PRESSED: f64 = 1e-9;

/// Share of its speed or pull below which a sliding ball's approach to another surface is rounding: that of projecting
/// a vector twice. Smaller: a ball in a corner is taken to run into the surface that it slides along.
pub const SLIDE_ROUNDING: f64 = 1e-12;

/// Two surfaces whose normals agree to this (1 - cosine of 1.4 mrad) are one smooth surface where they meet. Smaller:
/// a ball that rolls over a smooth joint meets it. Larger: a real kink is rolled over without a bounce.
pub const SMOOTH_JOINT: f64 = 1e-6;

/// An arc begins where a straight piece ends if their gap is below this share of their size: what a table's decimals
/// leave after sines and cosines. Smaller: balls meet the joints of arches. Larger: true corners are taken for joints.
pub const JOINT_GAP: f64 = 1e-9;

/// Touch gaps beyond the end of a straight surface within which a ball is still at that end. Positions along a surface
/// have more roundings than those across. Smaller: a ball falls between two pieces of a wall.
pub const END_SLACK: f64 = 16.0;

/// Rest speeds below which a ball between two surfaces comes to lie still. Smaller: it rattles for longer, to the same
/// end. Larger: it is stopped where it still rolled.
pub const WEDGE_SPEEDS: f64 = 4.0;

/// Ball radii that a ball may be off a moving surface that it follows before it counts as having left: the error of a
/// tick is far below. Larger: it is pulled back from the air.
pub const LOST_CONTACT: f64 = 0.01;

/// Angle, rad, by which a flipper turns at the most while a ball on it follows one parabola: at 6 cm from the pivot such a
/// piece is 1.2 mm long and 3 micrometres high. Larger: shots depend on the tick, and a ball of 100 m/s sinks in. Smaller: a
/// ball that is shot costs more.
pub const PIECE_ANGLE: f64 = 0.02;

/// Speed of the table, m/s, below which what is left of a nudge is nothing: a two-hundredth of a ball's rest speed on a real
/// table. Smaller: more ticks of work after each nudge. Larger: its end is felt.
pub const STILL_TABLE: f64 = 1e-4;

/// Largest displacement and speed of a table and of its plumb bob, m and m/s, that a state may hold; accelerations are at most
/// the square of it. No hand comes near.
pub const MOST_SHAKE: f64 = 1e4;

/// Share of its ring's radius below which a plumb bob's swing is nothing. Larger: nudges one after the other do not add up.
pub const STILL_BOB: f64 = 1e-3;

/// Angle, rad, by which a ball turns at the most along a curve while it follows one parabola, where a tick is longer: such a piece
/// leaves the curve by a twenty-thousandth of its radius. Larger: a fast ball is seen with too much speed, and lost in tight
/// turns. Smaller: a fast ball costs more.
pub const ARC_ANGLE: f64 = 0.05;

/// Ball radii from a target's place within which a ball keeps the target from rising: a hundredth more than a touch.
pub const CLEAR_OF_TARGET: f64 = 1.01;

/// Share of the time to an impact by which Newton's last steps may move it. More than that is no polish: a graze without
/// slope, or a hop so short that the surface is known better than the coordinates are.
pub const POLISH_STEP: f64 = 1e-6;

/// Share of the impacts within a tick that are worth following after which no bounce is left in those with a moving surface or
/// another ball: a ball between a rising flipper and a wall is pushed, not hammered.
pub const PLASTIC_SHARE: u32 = 4;

/// How far from a kicker, in ball radii, a ball lies at the most that its coil kicks when all of them are fired: the rubber gives
/// that much. Smaller: a ball that rests a hair's breadth away stays there. Larger: one that lies beside it is kicked.
pub const KICKER_REACH: f64 = 0.05;
