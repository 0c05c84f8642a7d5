//! Where we differ from the paper, and why.

use super::exact::WATCHED;
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
            "Against the printed table the largest differences measured are 1.6·10⁻³ and 7·10⁻⁴ in ξ₁; in an earlier survey, not part of this program, none of 68 definitions gave all printed digits. "
            "Interpolating the frequency over some 400 branch points, as the paper did, moves the doublings and the Hopf point by an amount that depends on where the points lie, which the paper does not say: Table 1 here gives the spread over four ways of placing them, beside converged values. "
            "The converged relation interpolates in the square root of the energy above the sticking limit, in which the frequency is smooth, to rounding."
        }
        h3 { "Two signs in equations (29) and (30)" }
        p {
            "The square-root terms of both have the opposite sign in the printed text. As printed, (30) would allow no secondary Hopf point at all; equation (31), which follows from it, is right and belongs to the corrected sign. "
            "The corrected forms are confirmed by halving the perturbation parameter: the errors shrink at the stated order, the third; the orders found are with Fig. 4."
        }
        h3 { "The slow flow is not the exact system" }
        p {
            "The slow flow keeps one harmonic and averages over a cycle. Its secondary Hopf point lies 1 % from the exact one, but its torus doubles from ξ₁ = −0.106 on, the exact torus only from −0.131, and for κ = 0.21 its limit cycle stays stable up to the last part before the fold, where the exact one loses and regains stability. "
            "At the same ξ₁ the largest amplitude differs by up to 10 %, the smallest by up to 30 % (near −0.09). Its frequency is known for energies up to 500 only and is never extrapolated: motions beyond count as diverged."
        }
        h3 { "Exact events instead of time steps" }
        p {
            "The paper integrates the equations of motion numerically in time. Here the motion between two changes of contact is the closed-form solution of a linear system, and each change is located to rounding, with a bound that certifies that none is missed. "
            "Limit cycles are fixed points of the exact return map, and secondary Hopf points come from its multipliers, not from watching amplitudes: they are sharp where a simulated amplitude diagram blurs them. "
            "Chaotic motions differ from any other computation after some hundred periods, so only statistics of them can be compared."
        }
        h3 { "The edge of divergence is not sharp" }
        p {
            "Close to divergence the bounded motion is a long chaotic transient that ends at a random-looking time, so the value read off depends on how long one watches and where one starts. Edges of divergence are those of motions started beside the limit cycle and, unless stated otherwise, watched for " (WATCHED) " time units."
        }
    }
}
