//! The figures and the table of the paper, computed, checked and drawn.
