//! The elements of all contacts, one after the other.

use super::microslip::{Loaded, Microslip};
use crate::contact::{
    Bound, ContactLaw, Elastic, PointState, Slider, SlipElement, SlipPlane, REVERSALS,
};
use crate::model::Model;
use crate::Error;
use faer::Mat;
use std::ops::Range;
use std::sync::Arc;

/// Places for the reversals that a law remembers in a transient.
const PLACES: usize = 512;

/// An element of a contact: its law, its points and what deforms in it.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    pub(crate) law: Arc<dyn SlipElement>,
    /// Position of its contact.
    pub(crate) contact: usize,
    /// Its points among those of all elements.
    pub(crate) points: Range<usize>,
    /// Those of them whose force it remembers.
    pub(crate) remembered: Vec<usize>,
    /// What else it remembers, among all such numbers.
    pub(crate) memory: Range<usize>,
    /// How many numbers a state tells of it.
    pub(crate) told: usize,
    /// Stiffness of a law without sliders that is marched: it remembers the ways from reversal to
    /// reversal times that, in more places than a state tells.
    pub(super) ways: Option<f64>,
    /// Its strains among those of the model.
    pub(crate) strains: Range<usize>,
    /// Of the forces that it remembers.
    pub(crate) elastic: Elastic,
}

impl Body {
    /// The slider that an element is whose one point remembers its force and has a constant limit.
    pub(super) fn slider(&self) -> Option<Slider> {
        match (&self.law.bounds()[..], &self.remembered[..]) {
            (&[Bound::Constant(slip_force)], [_]) => {
                Some(Slider { stiffness: self.law.stiffness()[(0, 0)], slip_force })
            }
            _ => None,
        }
    }
}

/// The elements of all contacts, and the contact displacement that each of their points acts on.
pub(super) struct Bodies {
    pub(super) all: Vec<Body>,
    pub(super) components: Vec<usize>,
    /// Those without sliders.
    pub(super) microslips: Vec<Microslip>,
}

impl Bodies {
    /// Elements that a motion can be followed by from event to event; where `marched`, laws that
    /// have none take part as a whole, by their return maps.
    pub(super) fn new(model: &Model, marched: bool) -> Result<Self, Error> {
        let mut bodies = Self { all: Vec::new(), components: Vec::new(), microslips: Vec::new() };
        for (contact, (law, range)) in model.laws().iter().zip(model.points()).enumerate() {
            match law.elements() {
                Some(elements) => {
                    for element in elements {
                        let own = element.components.iter().map(|own| range.start + own);
                        bodies.add(contact, own, element.law, None)?;
                    }
                }
                None if !marched && law.loading().is_some() => {
                    let Some(curve) = law.loading() else { continue };
                    let own = Arc::new(Loaded(curve.clone()));
                    bodies.add(contact, range.clone(), own, Some(1 + REVERSALS))?;
                    let Some(body) = bodies.all.last() else { continue };
                    bodies.microslips.push(Microslip {
                        point: body.points.start,
                        memory: body.memory.clone(),
                        breaks: curve.breaks(),
                        curve,
                    });
                }
                None if marched => {
                    let own = law.with_memory(PLACES);
                    let own = own.unwrap_or_else(|| law.with_scaled_stiffness(1.0));
                    let size = own.state_size();
                    bodies.add(contact, range.clone(), Arc::new(Marched(own)), Some(size))?;
                    if let (Some(curve), Some(body)) = (law.loading(), bodies.all.last_mut()) {
                        body.told = 1 + REVERSALS;
                        body.ways = Some(curve.stiffness());
                    }
                }
                None => {
                    let law = law.name().to_owned();
                    return Err(Error::NoEvents { contact: contact + 1, law });
                }
            }
        }
        Ok(bodies)
    }

    /// Adds an element that remembers its forces, or so many other numbers.
    fn add(
        &mut self,
        contact: usize,
        components: impl Iterator<Item = usize>,
        law: Arc<dyn SlipElement>,
        memory: Option<usize>,
    ) -> Result<(), Error> {
        let (bounds, stiffness) = (law.bounds(), law.stiffness());
        let held: Vec<bool> = bounds
            .iter()
            .map(|bound| matches!(bound, Bound::Constant(_) | Bound::Friction { .. }))
            .collect();
        let own = Mat::from_fn(held.len(), held.len(), |i, j| {
            if held[i] && held[j] {
                stiffness[(i, j)]
            } else {
                0.0
            }
        });
        let elastic = Elastic::new(own.as_ref())?;
        let (strains, memories) =
            self.all.last().map_or((0, 0), |body| (body.strains.end, body.memory.end));
        let start = self.components.len();
        self.components.extend(components);
        let points = start..self.components.len();
        let forces = points.clone().filter(|i| memory.is_none() && held[i - start]);
        self.all.push(Body {
            law,
            contact,
            remembered: forces.collect(),
            points,
            memory: memories..memories + memory.unwrap_or(0),
            told: memory.unwrap_or(0),
            ways: None,
            strains: strains..strains + elastic.rank(),
            elastic,
        });
        Ok(())
    }

    /// Slip limits of all points, 0 and infinite ones where there is no limit.
    pub(super) fn limits(&self) -> Vec<f64> {
        self.all.iter().flat_map(|body| body.law.limits()).collect()
    }

    /// Points whose force follows from their displacement and varies.
    pub(super) fn normals(&self) -> Vec<usize> {
        let bounds = self.bounds().into_iter().enumerate();
        bounds
            .filter(|(_, bound)| matches!(bound, Bound::Unilateral { stiffness, .. } if *stiffness > 0.0))
            .map(|(point, _)| point)
            .collect()
    }

    /// Pairs of points that slip in a plane.
    pub(super) fn planes(&self) -> Vec<SlipPlane> {
        let of = |body: &Body| {
            let first = body.points.start;
            let placed = move |plane: SlipPlane| SlipPlane {
                points: plane.points.map(|point| first + point),
                ..plane
            };
            body.law.planes().into_iter().map(placed).collect::<Vec<_>>()
        };
        self.all.iter().flat_map(of).collect()
    }

    /// What bounds the forces of all points, which are counted over all elements.
    pub(super) fn bounds(&self) -> Vec<Bound> {
        let of = |body: &Body| {
            let first = body.points.start;
            let placed = move |bound: Bound| match bound {
                Bound::Friction { friction, normal } => {
                    Bound::Friction { friction, normal: first + normal }
                }
                other => other,
            };
            body.law.bounds().into_iter().map(placed).collect::<Vec<_>>()
        };
        self.all.iter().flat_map(of).collect()
    }
}

/// A law that is followed by its return map, without events.
#[derive(Debug)]
struct Marched(Box<dyn ContactLaw>);

impl SlipElement for Marched {
    fn stiffness(&self) -> Mat<f64> {
        self.0.stiffness()
    }

    /// Its return map keeps them.
    fn limits(&self) -> Vec<f64> {
        vec![f64::INFINITY; self.0.displacements()]
    }

    fn tangent(&self, _points: &[PointState]) -> Mat<f64> {
        self.0.stiffness()
    }

    fn slip_rate(&self, points: &[PointState]) -> Mat<f64> {
        Mat::zeros(points.len(), points.len())
    }

    fn increment(
        &self,
        before: &[f64],
        after: &[f64],
        force: &mut [f64],
        gain: Option<&mut [f64]>,
    ) {
        self.march(before, after, &mut vec![0.0; self.0.state_size()], force);
        if let Some(gain) = gain {
            gain.fill(0.0);
        }
    }

    fn march(&self, before: &[f64], after: &[f64], memory: &mut [f64], force: &mut [f64]) {
        self.0.return_map(before, after, memory, force, None);
    }
}
