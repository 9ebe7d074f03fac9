//! What decides the onset of slip in two directions, on a grid of the period.

use super::drive::Drive;

/// K, M and their slopes on a grid, fine enough that no excess hides between two of its angles.
pub(super) struct Grid {
    pub(super) step: f64,
    /// Samples of Kx, Ky and M over the span.
    pub(super) value: [Vec<f64>; 3],
    slope: [Vec<f64>; 3],
    half_wave: bool,
}

impl Grid {
    pub(super) fn new(drive: &Drive<'_>) -> Self {
        let table = drive.table;
        let count = table.coarse_samples();
        let constant = |_: ()| [vec![drive.limit()[0]; count], vec![0.0; count]];
        let sampled = |series: &[f64]| {
            let [value, slope, _] = table.jets(series);
            [value, slope]
        };
        let limit =
            drive.pressing.as_ref().map_or_else(|| constant(()), |_| sampled(&drive.limit()));
        let [x, y] = [sampled(drive.pull(0)), sampled(drive.pull(1))];
        let ([x, x_slope], [y, y_slope], [limit, limit_slope]) = (x, y, limit);
        Self {
            step: drive.harmonics().span() / count as f64,
            value: [x, y, limit],
            slope: [x_slope, y_slope, limit_slope],
            half_wave: drive.harmonics().half_wave(),
        }
    }

    pub(super) fn count(&self) -> usize {
        self.value[0].len()
    }

    /// Values and slopes at any angle of the grid, mirrored in every other span under half-wave symmetry.
    pub(super) fn at(&self, n: usize) -> [[f64; 2]; 3] {
        let (turn, index) = (n / self.count(), n % self.count());
        let sign = if self.half_wave && turn % 2 == 1 { -1.0 } else { 1.0 };
        std::array::from_fn(|i| {
            let sign = if i == 2 { 1.0 } else { sign };
            [sign * self.value[i][index], sign * self.slope[i][index]]
        })
    }

    /// Slider positions along one direction outside of which the limit is passed at some instant.
    pub(super) fn room(&self, direction: usize) -> [f64; 2] {
        let pairs = self.value[direction].iter().zip(&self.value[2]);
        pairs.fold([f64::NEG_INFINITY, f64::INFINITY], |[low, high], (pull, limit)| {
            [low.max(pull - limit), high.min(pull + limit)]
        })
    }
}

/// `|K − s|² − M²` and half its slope.
pub(super) fn excess(at: [[f64; 2]; 3], slider: [f64; 2]) -> [f64; 2] {
    let [x, y, limit] = at;
    let (x, x_slope) = (x[0] - slider[0], x[1]);
    let (y, y_slope) = (y[0] - slider[1], y[1]);
    let value = x * x + y * y - limit[0] * limit[0];
    [value, x * x_slope + y * y_slope - limit[0] * limit[1]]
}
