//! Complexification-averaging: describing function and slow flow, equations (4)-(16) of the paper.
