//! Where we differ from the paper, and why.

use super::item::Case;
use maud::{Markup, html};

/// The section of the page.
pub(super) fn section(case: &Case) -> Markup {
    html! {
        h2 id="differences" { "Where we differ from the paper, and why" }
        @if !case.is_nominal() { p { "Written for the nominal parameters." } }
        h3 { "Table 1 cannot be met to its printed digits" }
        p {
            "The paper leaves open how the potential energy of the Jenkins spring enters the averaged energy (15), on which the frequency (16) depends. "
            "We take the mean of the stored energy over a period (mean potential), which is what the words say, and give the equivalent-stiffness form beside it. "
            "Against the printed table the largest differences measured are 1.6·10⁻³ and 7·10⁻⁴ in ξ₁; no definition that was tried, of 68, gives all printed digits. "
            "Interpolating the frequency over 400 branch points, as the paper did, moves the first doubling by 2·10⁻⁵ to 1.6·10⁻⁴ depending on where the points lie; ours are converged."
        }
        h3 { "Two signs in equations (29) and (30)" }
        p {
            "The square-root terms of both have the opposite sign in the printed text. As printed, (30) would allow no secondary Hopf point at all; equation (31), which follows from it, is right and belongs to the corrected sign. "
            "The corrected forms were confirmed by halving the perturbation parameter: the errors shrink at the stated order."
        }
        h3 { "Exact events instead of time steps" }
        p {
            "The paper integrates the equations of motion numerically in time. Here the motion between two changes of contact is the closed-form solution of a linear system, and each change is located to rounding, with a bound that certifies that none is missed. "
            "Limit cycles are fixed points of the exact return map, and secondary Hopf points come from its multipliers, not from watching amplitudes: they are sharp where a simulated amplitude diagram blurs them. "
            "Chaotic motions differ from any other computation after some hundred periods, so only statistics of them can be compared."
        }
        h3 { "The edge of divergence is not sharp" }
        p {
            "Close to divergence the bounded motion is a long chaotic transient that ends at a random-looking time, so the value read off depends on how long one watches and where one starts. We state the time watched with each value."
        }
    }
}
