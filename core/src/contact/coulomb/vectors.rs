//! Vectors in the plane of a contact.

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(super) fn less(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn size(a: [f64; 2]) -> f64 {
    a[0].hypot(a[1])
}

/// Solves two equations; nothing where they are singular.
pub(super) fn solve(rows: [[f64; 2]; 2], right: [f64; 2]) -> Option<[f64; 2]> {
    let determinant = cross(rows[0], rows[1]);
    let solution = [
        (right[0] * rows[1][1] - right[1] * rows[0][1]) / determinant,
        (rows[0][0] * right[1] - rows[1][0] * right[0]) / determinant,
    ];
    solution.iter().all(|x| x.is_finite()).then_some(solution)
}
