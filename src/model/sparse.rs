//! Square matrices of which few entries are not zero, as chains of oscillators coupled to few others have.

use nalgebra::DMatrix;

/// The entries of a square matrix that are not zero, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct SparseMatrix {
    /// Entries of row i: `starts[i]..starts[i + 1]`, in order of columns.
    starts: Vec<usize>,
    entries: Vec<(usize, f64)>,
}

impl SparseMatrix {
    #[must_use]
    pub fn of(matrix: &DMatrix<f64>) -> Self {
        let mut starts = vec![0];
        let mut entries = Vec::new();
        for i in 0..matrix.nrows() {
            let row = (0..matrix.ncols()).map(|j| (j, matrix[(i, j)]));
            entries.extend(row.filter(|(_, value)| *value != 0.0));
            starts.push(entries.len());
        }
        Self { starts, entries }
    }

    /// Number of rows.
    #[must_use]
    pub fn size(&self) -> usize {
        self.starts.len() - 1
    }

    /// The rows in order, each as columns and values.
    pub fn rows(&self) -> impl Iterator<Item = &[(usize, f64)]> {
        self.starts.windows(2).map(|bounds| &self.entries[bounds[0]..bounds[1]])
    }

    /// `target -= matrix * values`, for slices of the right length.
    pub fn subtract_product(&self, values: &[f64], target: &mut [f64]) {
        for (row, target) in self.rows().zip(target) {
            for (column, value) in row {
                *target -= value * values[*column];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_of_the_whole_matrix() {
        let whole = DMatrix::from_row_slice(3, 3, &[1.0, 0.0, 2.0, 0.0, 0.0, 0.0, -3.0, 4.0, 0.5]);
        let sparse = SparseMatrix::of(&whole);
        assert_eq!((sparse.size(), sparse.rows().map(<[_]>::len).collect::<Vec<_>>()), (3, vec![2, 0, 3]));
        let mut target = [1.0; 3];
        sparse.subtract_product(&[1.0, 2.0, 4.0], &mut target);
        assert_eq!(target, [1.0 - 9.0, 1.0, 1.0 - 7.0]);
    }
}
