//! Stiffness and exact shape functions of a straight beam.

use nalgebra::{SMatrix, SVector, Vector4};

pub(crate) type Matrix12 = SMatrix<f64, 12, 12>;
pub(crate) type Vector12 = SVector<f64, 12>;

/// Bending in one plane. The four dofs are deflection and slope at each end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bending {
    pub ei: f64,
    /// 12 EI / (G As L^2): 0 without shear deformation.
    pub phi: f64,
    /// Where the four dofs stand among the twelve, and their sign there: in
    /// the x-z plane the slope dw/dx is -ry.
    pub dofs: [(usize, f64); 4],
}

/// Deflection and section rotation per end dof at one place.
pub(crate) struct Shape {
    pub deflection: Vector4<f64>,
    pub rotation: Vector4<f64>,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Beam {
    pub length: f64,
    pub ea: f64,
    pub gj: f64,
    /// In the local x-y plane (Iz) and in the local x-z plane (Iy).
    pub planes: [Bending; 2],
}

const XY: [(usize, f64); 4] = [(1, 1.0), (5, 1.0), (7, 1.0), (11, 1.0)];
const XZ: [(usize, f64); 4] = [(2, 1.0), (4, -1.0), (8, 1.0), (10, -1.0)];

impl Beam {
    /// `stiffness` is (EA, GJ), `bending` is (EI, G As) for x-y, then x-z.
    pub(crate) fn new(length: f64, stiffness: (f64, f64), bending: [(f64, f64); 2]) -> Self {
        let plane = |(ei, shear): (f64, f64), dofs| Bending {
            ei,
            phi: 12.0 * ei / (shear * length * length),
            dofs,
        };
        Self {
            length,
            ea: stiffness.0,
            gj: stiffness.1,
            planes: [plane(bending[0], XY), plane(bending[1], XZ)],
        }
    }

    pub(crate) fn stiffness(&self) -> Matrix12 {
        let mut k = Matrix12::zeros();
        for (first, stiffness) in [(0, self.ea), (3, self.gj)] {
            let (i, j) = (first, first + 6);
            k[(i, i)] = stiffness / self.length;
            k[(j, j)] = stiffness / self.length;
            k[(i, j)] = -stiffness / self.length;
            k[(j, i)] = -stiffness / self.length;
        }
        for plane in &self.planes {
            let block = plane.stiffness(self.length);
            for (a, (row, row_sign)) in plane.dofs.into_iter().enumerate() {
                for (b, (column, column_sign)) in plane.dofs.into_iter().enumerate() {
                    k[(row, column)] = block[a][b] * row_sign * column_sign;
                }
            }
        }
        k
    }
}

impl Beam {
    /// Twice the shortening of the chord by deflection, as a form of the dofs: the geometric
    /// stiffness per unit of axial force.
    pub(crate) fn geometric(&self) -> Matrix12 {
        let mut g = Matrix12::zeros();
        for plane in &self.planes {
            let block = plane.geometric(self.length);
            for (a, (row, row_sign)) in plane.dofs.into_iter().enumerate() {
                for (b, (column, column_sign)) in plane.dofs.into_iter().enumerate() {
                    g[(row, column)] = block[a][b] * row_sign * column_sign;
                }
            }
        }
        g
    }
}

impl Bending {
    /// The integral of v' v' over the length, with the shapes below (Przemieniecki, Theory of
    /// Matrix Structural Analysis, 1968, chapter 15; with shear, v' is the slope of the axis).
    /// What does not bend at all deflects as a string.
    fn geometric(&self, length: f64) -> [[f64; 4]; 4] {
        let phi = self.phi;
        let (across, side, near, far) = if self.ei > 0.0 {
            let c = 1.0 / (1.0 + phi).powi(2);
            let shear = phi / 6.0 + phi * phi / 12.0;
            (
                c * (1.2 + 2.0 * phi + phi * phi) / length,
                c * 0.1,
                c * length * (2.0 / 15.0 + shear),
                c * length * (-1.0 / 30.0 - shear),
            )
        } else {
            (1.0 / length, 0.0, 0.0, 0.0)
        };
        [
            [across, side, -across, side],
            [side, near, -side, far],
            [-across, -side, across, -side],
            [side, far, -side, near],
        ]
    }

    fn stiffness(&self, length: f64) -> [[f64; 4]; 4] {
        let c = self.ei / ((1.0 + self.phi) * length.powi(3));
        let side = 6.0 * length * c;
        let near = (4.0 + self.phi) * length * length * c;
        let far = (2.0 - self.phi) * length * length * c;
        let across = 12.0 * c;
        [
            [across, side, -across, side],
            [side, near, -side, far],
            [-across, -side, across, -side],
            [side, far, -side, near],
        ]
    }

    /// At `xi` = x / length. These solve the unloaded beam exactly, so by
    /// reciprocity they give exact fixed-end forces of any load.
    pub(crate) fn shape(&self, length: f64, xi: f64) -> Shape {
        let (phi, scale) = (self.phi, 1.0 / (1.0 + self.phi));
        let bow = xi - xi * xi;
        let deflection = Vector4::new(
            1.0 - xi * xi * (3.0 - 2.0 * xi) + phi * (1.0 - xi),
            length * bow * (1.0 - xi + 0.5 * phi),
            xi * xi * (3.0 - 2.0 * xi) + phi * xi,
            -length * bow * (xi + 0.5 * phi),
        );
        let rotation = Vector4::new(
            -6.0 * bow / length,
            (1.0 - xi) * (1.0 - 3.0 * xi + phi),
            6.0 * bow / length,
            xi * (3.0 * xi - 2.0 + phi),
        );
        Shape {
            deflection: deflection * scale,
            rotation: rotation * scale,
        }
    }
}
