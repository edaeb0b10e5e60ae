"""Rotations, frames and primitives. This page holds the conventions; everything obeys it.

Units are SI. Angles are radians inside, degrees in YAML keys that end in ``_deg``.

Frames
    W   world, z up, origin on the ground
    B   body, origin O_b at the vehicle's reference point; x forward, y left, z up
    T   tool, origin at the tip, z out along the tool; y_T = y_B, x_T = y_T × z_T
    C   contact, origin on the surface, z the surface's outward normal (towards the vehicle),
        x level along the surface where it has a level direction; a pressing tool has
        z_T = −z_C
    S   a surface's own frame: origin at its centre, coordinates (u, v) along it, n outward
    D   the depth camera, axes parallel to T's

Monogram notation
    p_WB        position of B's origin, measured and expressed in W
    R_WB        rotation that turns coordinates in B into coordinates in W: x_W = R_WB x_B
    q_WB        the same rotation as a unit quaternion (w, x, y, z) with w ≥ 0 when normalised
    v_WB_W      velocity of B's origin in W, expressed in W
    w_WB_B      angular velocity of B in W, expressed in B
    wrench_B    (force, torque) about O_b, expressed in B; six numbers, force first

Attitude errors are right perturbations: R_true = R_nominal Exp(θ), θ in the body frame.
"""
