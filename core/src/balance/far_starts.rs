//! Starts from which other vibrations are looked for than one that is known.

/// Complex multiples of the known vibration, …
const MULTIPLES: [[f64; 2]; 3] = [[-3.0, 0.0], [0.0, 3.0], [0.0, -3.0]];
/// … of that without slip, …
const OF_STUCK: [[f64; 2]; 2] = [[-3.0, 0.0], [0.0, 3.0]];
/// … and the known one with a motion added that opens a contact or all of them, over its largest
/// component.
const OPENING: [f64; 2] = [3.0, 10.0];
/// Single contacts that are opened at a time.
const OPENED: usize = 3;

/// Large vibrations out of phase with a known one and with the `stuck` response, and those in which
/// contacts open, one by one, all at once and in turn: `last` are the last components of the contacts,
/// the normal ones of those that have one. `survey` counts the calls: contacts and phases differ from one
/// to the next. A series has so many `slots`.
pub(crate) fn far_starts(
    [known, stuck]: [&[f64]; 2],
    slots: usize,
    last: &[usize],
    survey: usize,
) -> Vec<Vec<f64>> {
    // Without half-wave symmetry the mean comes first.
    let first = slots % 2;
    let fundamental = known.chunks_exact(slots).flat_map(|own| &own[first..first + 2]);
    let largest = fundamental.fold(0.0_f64, |most, x| most.max(x.abs()));
    let (quarter, sign) = (survey % 2, if survey % 4 < 2 { 1.0 } else { -1.0 });
    let open = |u: &mut Vec<f64>, component: usize, by: f64| {
        u[component * slots + first + quarter] += sign * by * largest;
    };
    let [one, all] = OPENING;
    let together = [1.0, -1.0].map(|next: f64| {
        let mut u = known.to_vec();
        let signs = std::iter::successors(Some(1.0), |sign| Some(sign * next));
        last.iter().zip(signs).for_each(|(at, sign)| open(&mut u, *at, sign * all));
        u
    });
    let begin = survey * OPENED;
    let singly = (begin..begin + OPENED.min(last.len())).map(|turn| {
        let mut u = known.to_vec();
        open(&mut u, last[turn % last.len()], one);
        u
    });
    let multiples = MULTIPLES.iter().map(|by| turned(known, slots, *by));
    let of_stuck = OF_STUCK.iter().map(|by| turned(stuck, slots, *by));
    multiples.chain(of_stuck).chain(together).chain(singly).collect()
}

/// A vibration whose harmonics are multiplied by a complex number.
pub(super) fn turned(of: &[f64], slots: usize, [re, im]: [f64; 2]) -> Vec<f64> {
    let mut u = of.to_vec();
    let harmonics = u.chunks_exact_mut(slots).flat_map(|own| own[slots % 2..].chunks_exact_mut(2));
    harmonics.for_each(|x| x.copy_from_slice(&[re * x[0] - im * x[1], im * x[0] + re * x[1]]));
    u
}
