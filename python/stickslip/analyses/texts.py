"""What diagnostics say, by their codes; numbers and names come from their data."""

from __future__ import annotations

from stickslip.results.diagnostic import Diagnostic, diagnostic

TEXTS = {
    # nonlinear modes
    "mode-at-rest": "Mode {mode} has {omega:.8g} rad/s and a damping ratio of {ratio:.6g} with "
    "its contacts as they are at rest; periodic forces are left out, static loads kept.",
    "mode-at-rest/phase-resonance": "Mode {mode} has {omega:.8g} rad/s and a damping ratio of "
    "{ratio:.6g} with its contacts as they are at rest; the forces of harmonic 1 keep it up, in "
    "quadrature with the displacement along them.",
    "mode-at-rest/quasi-static": "Mode {mode} has {omega:.8g} rad/s and a damping ratio of "
    "{ratio:.6g} with its contacts as they are at rest; a load of its shape is raised without "
    "inertia, so that the shape keeps to it and higher harmonics are left out.",
    "internal-resonance": "At {points} of the amplitudes, from {_first:.4g} on, harmonic {order} "
    "meets the stuck natural frequency of {frequency:.6g} rad/s with {share:.0%} of the amplitude: "
    "the mode is an internal resonance there, and other branches lie close by.",
    "internal-resonance/between": "Between the amplitudes asked for, at {amplitude:.4g}, harmonic "
    "{order} meets the stuck natural frequency of {frequency:.6g} rad/s with {share:.0%} of the "
    "amplitude: the mode is an internal resonance there, and other branches lie close by.",
    "turns": "The branch turns back in amplitude at {_listed}.",
    "mode-not-reached": "The branch ended at the amplitude {amplitude:.6g} ({_why}): {_remedy}.",
    "mode-not-reached/start": "No motion near the linear mode was found at small amplitudes: ask "
    "for a mode that stands apart from others{_driven}.",
    "mode-not-reached/microslip": "No motion near the linear mode was found: at the amplitude "
    "{amplitude:.6g} contacts already slip so much that the frequency is {omega:.6g} rad/s instead "
    "of {linear:.6g}. Begin at amplitudes smaller by many orders, or take "
    "method='quasi-static'{_apart}.",
    # flutter maps
    "wave-stability": "Limit cycles count as stable where the damping ratio rises with the "
    "amplitude: against changes of the amplitude of their own wave. Other waves beside them are "
    "not looked at.",
    "wave-stability/ring": "The stability of limit cycles is that of the ring of all sectors, by "
    "its Floquet multipliers; not decided where they are not found or too near the unit circle.",
    "waves-missing": "At {points} of {total} amplitudes of waves the nonlinear mode was not found; "
    "limit cycles there are missing: give amplitudes closer to those around.",
    "waves-unheld": "{waves} waves still grow at the largest amplitude, {largest:.6g} m kg^(1/2): "
    "from there nothing holds them as far as was looked.",
    "cycles-differ": "Of {cycles} limit cycles the amplitude differs by more than {least:.0%} from "
    "the solution of the whole equations, by {largest:.1%} at most: one mode does not tell them; "
    "`ss.limit_cycles` of the wave does.",
    # the method
    "harmonics": "All harmonics from 0 to {most} were solved for{_chosen}.",
    "harmonics/odd": "Only the odd harmonics up to {most} were solved for{_chosen}: the forces and "
    "the friction laws are half-wave symmetric.",
    "harmonics/one": "Only harmonic 1 was solved for: the forces and the friction laws are "
    "half-wave symmetric, and harmonics above it were left out.",
    "harmonics/orbits": "Harmonics are reported up to {most}; the orbits have no truncation.",
    "harmonics/peaks": "Harmonics up to {most} were kept.",
    "harmonics/chosen": "Harmonics up to {most} were kept{_several}, chosen at each peak to a "
    "tolerance of {_tolerance:g}.",
    "samples": "The contact forces{_of} were marched through {_count} samples per period{_chosen}; "
    "the error of the sampling is part of the error estimate.",
    "samples/fixed": "The contact force of {_laws} was taken at 1024 instants per period, whose "
    "error is no part of the error estimate; evaluation='marched' chooses their number by it.",
    "method/single": "The motion was taken to be harmonic, and of every contact force its first "
    "harmonic: Griffin's method with complex amplitudes.",
    "method/free": "The motion was followed exactly between the instants of stick and slip; "
    "decaying and unbounded are bounds that hold for ever, settled and aperiodic what was seen of "
    "it.",
    "no-error-estimate": "The error of leaving the higher harmonics out was not estimated; "
    "estimate=True does it.",
    "mass-scaling": "Modes of up to {fastest:.4g} rad/s, {modes} in all, were slowed to "
    "{slowed:.4g} rad/s by mass that moves in their shapes alone; by an estimate the contacts move "
    "differently by {change:.1e} of their motion.",
    "mass-scaling/none": "No mode can be slowed to a tolerance of {tolerance:g}: all are as they "
    "are.",
    "half-period": "Only motions of the period of the forces were sought.",
    "half-period/half": "Orbits were sought on half a period: the forces and the friction laws are "
    "half-wave symmetric, and so is the steady motion.",
    "modal-base/stuck modes": "The damping is proportional on the stuck structure: the compliance "
    "is the sum over its real modes.",
    "modal-base/coupled stuck modes": "The damping couples the modes of the stuck structure: the "
    "compliance is the sum over its real modes, their coupling added by iteration.",
    "modal-base/sparse factors": "The matrices hold few numbers: points cost a sparse "
    "factorisation per harmonic, and no mode is computed.",
    "modal-base/free modes": "The damping is proportional on the free structure: the compliance is "
    "the sum over its real modes, the stuck contacts added exactly.",
    "modal-base/complex modes": "The damping matrix couples the modes, or rounding leaves open "
    "whether it does: the compliance is the sum over the complex modes of the stuck structure.",
    "modal-base/waves": "All sectors are equal and move alike, one after the other: harmonic k of "
    "the motion meets the disk at nodal diameter k E modulo n. With positive damping that is its "
    "only steady state.",
    "modal-base/sectors": "The sectors of the ring are solved one by one, and joined exactly where "
    "neighbours touch.",
    "direct-solution": "The damping matrix couples the modes, and the complex modes miss a direct "
    "solution by more than 1e-8, as where two of them nearly coincide, or a dof of hardly any mass "
    "makes one much faster than the others: every point costs a factorisation of the whole dynamic "
    "stiffness per harmonic, and takes longer than modes would. Where the damping follows a law, "
    "give that, Rayleigh or ModalDamping, instead of its matrix.",
    "exact-orbits": "{points} {_take} harmonics from the exact orbit, which costs less than a "
    "balance of as many.",
    "frequencies": "The {count} frequencies between {_low:g} and {_high:g} rad/s were chosen to a "
    "tolerance of {_tolerance:g}.",
    "frequencies/cut": "The run from {_start:g} to {_end:g} rad/s was interrupted: its {count} "
    "frequencies, chosen to a tolerance of {_tolerance:g}, end at {_reached:.6g} rad/s.",
    "frequencies/grid": "The run was interrupted after {count} of {_asked} frequencies, at "
    "{_reached:.6g} rad/s.",
    "frequencies/balance": "The frequencies between {_low:g} and {_high:g} rad/s are those that an "
    "adaptive harmonic balance chose to a tolerance of {tolerance:g}.",
    "observed-dofs": "Only {kept} of {total} dofs are kept in the result: {_listed}.",
    "law-not-monotone": "The contact law {_laws} is not monotone in the motion: the solution may "
    "be unstable or not the only one.",
    "law-not-monotone/peaks": "The contact law {_laws} is not monotone in the motion: a branch to "
    "which the curve does not lead may peak higher. forced_response over the range looks for such.",
    "rigid-contacts": "Nearly rigid: {_names}, up to {ratio:.1e} times as stiff as the structure "
    "there, and {points} {_are} not solved to the tolerance. Up to {_limit:.0e} times as stiff, "
    "motions are found. Lower the stiffness, which changes the motion by some thousandths, or try "
    'harmonics="auto", or exact_response, which names what is too fast to follow.',
    "free-flight": "Nothing touches {body!r} during {share:.0%} of the period at omega = "
    "{omega:.6g} rad/s: all contacts that hold it are open at once, and in free flight neither "
    "stiffness nor damping decides where it goes; raise its load, or check the motion in time.",
    "undamped-motion": "The damping leaves some motion undamped: a steady state that friction does "
    "not damp either may not be the only one.",
    "unbounded-resonance": "Neither damping nor friction bounds the resonance at {_all} rad/s, "
    "where {_dofs} would grow for ever: what points beside it have says how near they are, nothing "
    "else. Add damping, or more friction.",
    "negative-damping": "The damping is negative for some motion: the solution may be unstable or "
    "not the only one.",
    "few-modes": "The structure was reduced with modes that make it accurate up to {limit:.6g} "
    "rad/s; {_what} {omega:.6g} rad/s. Beyond, natural frequencies are more than 1 % too high, and "
    "resonances may be missing. Keep more modes: craig_bampton(..., omega={_enough:.4g}).",
    "negative-stiffness": "The stiffness matrix has a negative eigenvalue, mostly of dof {dof!r}: "
    "without its contacts the structure is statically unstable, and motions may be too. Check "
    "signs and supports, unless it is meant.",
    "phase-unit": "Force {force} at {dof!r} has a phase of {phase:g} rad; for degrees write "
    "'{phase:g} deg'.",
    "overdamped": "Damping ratio {ratio:g} is {ratio:.0%} of critical: such a mode does not "
    "oscillate; for {ratio:g} % give {_percent:g}.",
    "wave-damping": "The damping law means a ratio of {law:.3g}, but the lowest mode of nodal "
    "diameter {diameter} has {ratio:.3g}: the law is that of the sector by itself, without the "
    "interface. Give damping matrices of both, or Rayleigh damping of both.",
    "mistuning-unit": "{_what} deviates by {deviation:g}, which is {deviation:.0%}; for "
    "{deviation:g} % give {_percent:g}.",
    "friction-unit": "The coefficient of friction of {contact!r} is {friction:g}; for "
    "{friction:g} % give {_percent:g}.",
    "angle-unit": "The face {contact!r} of a damper is inclined by {angle:.6g} deg; for "
    "{angle:.6g} rad write '{angle:.6g} rad'.",
    "two-frequencies": "omega = [{low:g}, {high:g}] are two frequencies, and nothing between them "
    "was computed; a range is omega = ({low:g}, {high:g}), in study files "
    "{{ from = {low:g}, to = {high:g} }}.",
    "truncation": "{_what} could still change {dof!r} by {share:.1%} at omega = {omega:.6g} rad/s, "
    "the worst point; {_remedy}.",
    "truncation/peak": "The discarded harmonics could still change the peak by {share:.1%} at "
    "{_parameter} = {value:.6g}, the worst value; keep more harmonics.",
    "truncation/factors": "The discarded harmonics could still change amplification factors by up "
    "to {share:.1%} (dof {dof!r}); keep more harmonics.",
    "truncation/cycles": "The discarded harmonics could still change amplitudes by up to "
    "{share:.1e}; try {_finer}.",
    "harmonics-limit": "{count} {_noun} at the limit of harmonics; raise max_harmonics.",
    # fits
    "intervals/profile": "Intervals hold the true value with {confidence:.4g} if the errors are "
    "normal and independent: the misfit, least over the other parameters, rises to its limit at "
    "their ends.",
    "intervals/covariance": "Intervals hold the true value with {confidence:.4g} if the errors are "
    "normal and independent, and the model bends little over them: they follow from the "
    "covariance at the best fit.",
    "noise-estimated": "The noise was not given. It was estimated from the misfit, to "
    "{scatter:.3g} of the measured numbers, so that the misfit says nothing of how well the model "
    "fits.",
    "not-determined": "The data do not determine {parameter!r}: its interval, from {low:.6g} to "
    "{high:.6g}, {_said}. Measure where it acts, at other levels or frequencies, or fix its value.",
    "tied": "The data know {one!r} and {other!r} only together (correlation {correlation:.3f}): "
    "fix one of them, or measure where they act differently.",
    "at-bound": "{parameter!r} lies at its bound {bound:.6g}; widen the bounds if it may lie "
    "beyond.",
    "other-minimum": "Another minimum fits about as well, with {parameter!r} at {value:.6g}; "
    "narrow the bounds, or measure more.",
    "misfit-above-noise": "The model does not fit within the noise: the residuals of the {numbers} "
    "numbers scatter by {scatter:.3g} standard deviations. A better minimum may lie elsewhere: "
    "give nearer bounds, or more starts. Or another law fits better, or the noise is larger than "
    "given.",
    "predictions-missing": "{count} of {total} numbers could not be predicted by the best fit and "
    "count as zero; look at the forced response of the fitted model.",
    # uncertainty
    "samples-drawn/sobol": "The {count} samples are points of a scrambled Sobol sequence (seed "
    "{seed}), which fill the space more evenly than chance would: intervals of percentiles, which "
    "take them for random, are wider than need be.",
    "samples-drawn/random": "The {count} samples were drawn at random (seed {seed}).",
    "independent": "The {parameters} uncertain parameters are taken to be independent.",
    "samples-failed": "{count} of {total} samples failed, most of them so: {_common}. Intervals of "
    "percentiles let them lie anywhere; surrogates leave them out.",
    "truncation/samples": "The discarded harmonics could still change a number of a sample by up "
    "to {share:.1%}; keep more harmonics.",
    # the model
    "static-traction": "A contact that never slips was taken to hold {_held} "
    "(residual={residual!r}, of effect at {points} of {_solved} points); residual_bounds gives "
    "what it could hold.",
    "static-traction/nodes": "Nodes of a Coulomb contact that never slip in both senses were taken "
    "to hold {_held} (residual={residual!r}, of effect at {points} of {_solved} points), as far as "
    "the motion leaves it: under a normal load that varies the vibration depends on it.",
    "static-traction/peaks": "A contact that never slips was taken to hold residual={residual!r}.",
    "bounds": "The vibration depends on residual tractions at {points} of {_known} points. The "
    "bounds are inner ones: every amplitude in them is attained, and others could lie outside.",
    "bounds/modes": "Frequency or damping depend on residual tractions at {points} of {_known} "
    "amplitudes. The bounds are inner ones, of {corners} places in what Coulomb allows: others "
    "could lie outside.",
    "bounds/peaks": "The peak depends on residual tractions at {points} of {_known} values. The "
    "bounds are inner ones: every amplitude in them is attained, and others could lie outside.",
    "bounds-not-found": "At {points} points an orbit with the least or the largest amplitude was "
    "not found; forced_response has bounds there.",
    "bounds-not-found/modes": "In {places} of the {corners} places the mode was not found at all "
    "amplitudes: the bounds there are of the others.",
    "bounds/unique": "All residual tractions go with one vibration: the laws are monotone and the "
    "structure is damped, so that the bounds coincide.",
    "start-of-march": "The march through a damper of several points begins without slip, so that "
    "points which never slip hold what they built up from zero displacement, and no mean force "
    "where the motion is half-wave symmetric{_held}.",
    "start-of-march/nodes": "The march through a contact law of your own begins without slip, so "
    "that nodes which never slip hold the traction that they built up from zero displacement.",
    # transients and free motions
    "start": "The run starts from {_begun}.",
    "start/forces": "{_starts} given by displacements alone: their velocities and contact forces "
    "are zero at first. What a start leads to depends on its contact forces as well; give "
    "ss.State(model, displacement, contact_force=...) for others.",
    "start/given-forces": "The contact forces at the start were given, the largest is "
    "{contact_force:g} N.",
    "start/contacts": "The run starts from {_begun}; a contact that never slips keeps for ever the "
    "mean force of its start, so that means depend on it while half ranges do not.",
    "time-steps/exact": "The motion was followed exactly between the instants of stick and slip.",
    "time-steps/rk4": "The motion was advanced in {_steps} Runge-Kutta steps per period; between "
    "them the output is interpolated.",
    "kept-periods": "Time histories and events are kept of the last {periods} periods only.",
    "coarse-steps": "The highest stuck natural frequency turns by {turn:.2g} rad in a Runge-Kutta "
    "step, too much to be followed well; take {needed} steps per period.",
    "no-tolerance": "No tolerance was given, so that the last period need not be a steady one; see "
    "change.",
    "forces-left-out": "Forces of the model, {forces} in all, were left out: the motion is free.",
    "criterion": "A motion counts as settled at a closing error of {tolerance:g} that is falling, "
    "over 32 periods, and was followed over {periods} periods of the lowest stuck mode at most.",
    "modes": "Modes are those of the structure with all contacts stuck, told apart by kinetic "
    "energy.",
    # peaks along a parameter, and of many disks
    "peak-range": "{_what} from {low:.6g} to {high:.6g} rad/s.",
    "peak-at-edge": "{_what} from {low:.6g} to {high:.6g} rad/s; {_at_edge} at an end of this "
    "range, and the response may be higher outside: widen omega.",
    "varied-together": "All of {_names} have the same {_parameter}.",
    "varied-together/factor": "Each of {_names} has its own {_parameter} times the factor.",
    "varied-together/level": "The level multiplies the forces that vary; static loads stay.",
    "rigid-limit": "Stiffnesses above {_twice:.4g} N/m were not solved: an infinite stiffness is "
    "the limit of {stiffness:.4g} and {_twice:.4g} N/m, some hundred times the stiffness of the "
    "structure at the contact, taken as linear in 1/k_d, and finite ones lie on the same line; the "
    "error estimate holds the whole last change.",
    "coarse-search": "The least peak was looked for between {low:.6g} and {high:.6g}{_behind}; a "
    "local minimum narrower than the coarse curve of 40 values may have been passed over.",
    "optimum-at-bound": "The least peak lies at a bound; a better one may lie outside.",
    "patterns": "Patterns were drawn from a {distribution} distribution of zero mean and unit "
    "deviation with seed {seed}; those of a single disk have others.",
    "patterns/given": "The patterns were given, in units of the standard deviation.",
    "deviations": "The stiffness of whole sectors deviates; couplings, contacts and forces do not.",
    # several solutions
    "folds": "The curve turns back in frequency at {count} folds: between them a frequency has "
    "several motions.",
    "unstable": "{points} of {_solved} motions are unstable: a disturbance leads away from them.",
    "other-motion": "At {points} points the only motion found is unstable: there is another one, "
    "periodic or not, which the bounds may not hold. A transient shows it.",
    "jump": "The {_direction} sweep jumps to another branch between omega = {low:.6g} and "
    "{high:.6g} rad/s{_more}; a range, omega=(from, to), follows the branch around its fold.",
    "branch-unknown": "Whether the {_direction} sweep stays on its branch between omega = "
    "{low:.6g} and {high:.6g} rad/s{_more} is not known: the way from one motion to the other is "
    "too long. Give frequencies closer to each other; a range, omega=(from, to), follows the "
    "branch.",
    "further-branches": "{_branches} found beside the branch that begins at the end of the range, "
    "from other starts: {_first} from {low:.6g} to {high:.6g} rad/s.{_cut} There may be more.",
    "branch-end/returned": "The branch that begins at omega = {_start:.6g} rad/s comes back to "
    "that end of the range: the motions at the other end lie on another branch; begin there.",
    "branch-end/stalled": "Stalled: no way ahead of the branch was found at omega = {omega:.6g} "
    "rad/s; the rest of the range is missing.",
    "branch-end/points": "The branch ends at omega = {omega:.6g} rad/s after {points} points, "
    "the effort that a curve is granted; compute a shorter range, or with fewer harmonics.",
    # limit cycles
    "onset": "Mode {mode}, stuck at {omega:.6g} rad/s, loses its damping at r = {ratio:.6g} with "
    "all contacts stuck: its limit cycles begin there.",
    "onset/rest": "Mode {mode}, at {omega:.6g} rad/s with the contacts as they are at rest, loses "
    "its damping at r = {ratio:.6g}: its limit cycles begin there.",
    "half-wave/full": "Motions are solved for with their means and all harmonics. t = 0 is the "
    "maximum of {_dof!r}.",
    "half-wave": "Motions are half-wave symmetric, x(t + T/2) = -x(t); cycles that break this "
    "symmetry are not looked for. t = 0 is the maximum of {_dof!r}.",
    "forces-ignored": "The forces of the model are left out.",
    "forces-ignored/static": "The forces of the model are left out, but for static ones.",
    "stability-undecided/wave": "Stability is not decided: one sector of a wave has no motion of "
    "its own.",
    "stability-undecided/left out": "Stability is not decided: it was left out.",
    "stability-undecided/unproved": "Stability is not decided: the laws are monotone, but the "
    "damping leaves it open. exact_response has multipliers.",
    "stability-undecided": "The stability of {points} points is not decided: no exact orbit with "
    "multipliers was found, or the largest one is 1 to rounding. Look at the points beside them.",
    "stability-undecided/points": "The stability of {points} of {_solved} motions is not decided: "
    "a contact touches its limit without slipping, or the largest multiplier is too near to 1 for "
    "the harmonics kept. Take more harmonics, or a transient from a state nearby.",
    "stability-undecided/touching": "The stability of {points} of {_solved} orbits is not decided; "
    "they have no multipliers. A contact touches its limit there without slipping, and the "
    "stiffness on either side differs. A transient from a state nearby shows what a disturbance "
    "becomes.",
    "stability-undecided/neutral": "The stability of {points} of {_solved} orbits is not decided: "
    "their largest multiplier is 1 to rounding, as where nothing damps a motion. A transient from "
    "a state nearby shows what a disturbance becomes.",
    "stability-unknown": "Values whose stability is not decided: {count}.",
    "multipliers": "{points} points have no exact orbit nearby at their {_followed}: their "
    "multipliers are those of the exact flow along the harmonic balance.",
    "branch-turned-back": "Stalled: at {_followed} = {value:.6g} the continuation came back to "
    "points that it had passed, from a corner of the branch. The branch may go on beyond the "
    "corner, to a farther limit. {_remedy}",
    "branch-stalled": "Stalled: the {side} side ends at {_followed} = {value:.6g}, where no "
    "continuation was found. {_remedy}",
    "points-limit": "The branch ends after {points} points; raise max_points.",
    "unbounded-branch": "The {side} side grows without bound; it was followed to {_followed} = "
    "{value:.6g}.",
    "values-missed": "The branch has no limit cycle at {_followed} = {_at}; without a list of "
    "values the whole branch is followed, which shows how far it reaches.",
    "values-missed/unbounded": "No limit cycle was found at {_followed} = {_at}: the branch goes "
    "on with larger motions than it was followed to.",
    "values-missed/incomplete": "No limit cycle was found at {_followed} = {_at}, where there may "
    "be some all the same: the branch was not followed everywhere. {_remedy}",
    "no-turn": "No turn: the branch does not turn in the range, and has one side alone.",
    "no-limit": "{_name} = {value:.6g}: {_cause}",
    "branch-jumps": "{jumps} places were stepped over, at corners or between folds close to each "
    "other: limit cycles may be missing there. {_remedy}",
}
"""Texts by code, and of variants by "code/variant"; words begin with an underscore."""


def told(name: str, **data: object) -> Diagnostic:
    """Return a diagnostic, of whose data words are in the text alone."""
    numbers = {key: value for key, value in data.items() if not key.startswith("_")}
    return diagnostic(name.partition("/")[0], TEXTS[name].format(**data), **numbers)  # type: ignore[arg-type]
