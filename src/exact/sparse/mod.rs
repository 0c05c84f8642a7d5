//! Large chains: the exact flow at a cost per event that grows linearly with the number of oscillators, where each is coupled to few others.
//!
//! In every contact state the chain is linear, and its Taylor coefficients follow from sparse matrix-vector products alone:
//!
//! ```text
//! x(t) = sum_k x_k t^k,   (k+1)(k+2) M x_(k+2) = -K x_k - (k+1) (D + S) x_(k+1) - sum_j R_j f_(j,k) b_j
//! f_(j,0) = f_j,   f_(j,k) = (k_j/R_j) b_j^T x_k while element j sticks, 0 while it slips  (k >= 1)
//! ```
//!
//! No matrix depends on the contact pattern, and no exponential is formed. An event of any slider restarts the series; between events it is
//! restarted at the end of its cell.
//!
//! # Error control
//!
//! In the norm `|y| = max(w |x|, |v|, w |R f/k|)` with `w^2` the largest row sum of `M^-1 (|K| + sum_j k_j |b_j| |b_j|^T)`, the matrix of the system has
//! norm at most `r = max(w max_j |b_j|_1, w + |M^-1 (D + S)|)` in every contact state. The series of order p left off after `h` is wrong by at
//! most
//!
//! ```text
//! |y(0)| (r h)^(p+1)/(p+1)! / (1 - r h/(p+2))
//! ```
//!
//! and the cell of order p ends where that is 1e-17 |y(0)|: below the rounding of the sum. The order is one of 6, 8, ..., 16, the least whose
//! cell is twice the present time between events: many sliders make events frequent, and short cells need few terms.
//!
//! Events are certified: an element is passed over only if `|f_0| + sum |f_k| h^k < 1` (sliding velocities likewise) proves that it cannot
//! switch in the cell; all others go to the search with curvature bounds of [`super::crossing`]. Rules and order of events are those of
//! [`super::ChainFlow`], with which this flow shares no matrix.

mod flow;
mod series;
mod system;
mod tangent;
mod walk;

pub use flow::SparseFlow;
pub(super) use series::TaylorSeries;
pub(super) use system::SparseSystem;
