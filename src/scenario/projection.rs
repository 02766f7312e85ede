//! The image of an array's field of view: a pinhole with radial distortion.

use super::model::Array;

/// Steps of Newton's method from an image to a direction: each doubles the number of correct digits.
const STEPS: usize = 8;

/// Parts of a range of directions in which the order of their images is looked at.
const PARTS: u32 = 64;

/// The rectangle in the image plane that the pixels divide, for a focal length of 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    lens: Distortion,
    /// Half of the image's width and height.
    pub half: [f64; 2],
    /// Largest tangent of a direction by which the field of view is given.
    widest: f64,
}

/// Radial distortion of a lens.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Distortion([f64; 2]);

impl Distortion {
    /// Returns the distance from the axis at which a direction is imaged, both as tangents.
    fn image(self, tangent: f64) -> f64 {
        let Distortion([k1, k2]) = self;
        let square = tangent * tangent;
        tangent * (1.0 + (k1 + k2 * square) * square)
    }

    /// Returns the tangent of the direction that is imaged at that distance from the axis.
    fn tangent(self, image: f64) -> f64 {
        let Distortion([k1, k2]) = self;
        let mut tangent = image;
        for _ in 0..STEPS {
            let square = tangent * tangent;
            let slope = 1.0 + (3.0 * k1 + 5.0 * k2 * square) * square;
            tangent -= (self.image(tangent) - image) / slope;
        }
        tangent
    }

    /// Returns whether directions up to a tangent have images in the same order.
    fn is_monotonic(self, tangent: f64) -> bool {
        let Distortion([k1, k2]) = self;
        let slope = |part: u32| {
            let square = (tangent * f64::from(part) / f64::from(PARTS)).powi(2);
            1.0 + (3.0 * k1 + 5.0 * k2 * square) * square
        };
        (0..=PARTS).all(|part| slope(part) > 0.0)
    }
}

impl Projection {
    /// Returns the image of an array's field of view. Without one, it is the largest rectangle of square pixels inside
    /// a cone of the given full angle.
    pub fn of(keys: &Array, cone_deg: f64) -> Self {
        let lens = Distortion(keys.distortion);
        let tangent = |full_deg: f64| libm::tan((full_deg / 2.0).to_radians());
        let (half, widest) = match keys.field_of_view_deg.map(|full_deg| full_deg.map(tangent)) {
            Some(ends) => (ends.map(|end| lens.image(end)), ends[0].max(ends[1])),
            None => {
                let size = [keys.columns, keys.rows].map(f64::from);
                let unit = lens.image(tangent(cone_deg)) / size[0].hypot(size[1]);
                (size.map(|size| size * unit), tangent(cone_deg))
            }
        };
        Projection { lens, half, widest }
    }

    /// Returns whether the lens images all directions of the field of view apart from each other.
    pub fn is_distinct(&self) -> bool {
        let image = self.half[0].hypot(self.half[1]);
        let corner = self.lens.tangent(image);
        let is_found = (self.lens.image(corner) - image).abs() < 1e-9 * image;
        is_found && self.lens.is_monotonic(corner.max(self.widest))
    }

    /// Returns the distance from the axis at which a direction is imaged, both as tangents.
    pub fn image(&self, tangent: f64) -> f64 {
        self.lens.image(tangent)
    }

    /// Returns the direction that is imaged at a distance from the axis, both as tangents.
    pub fn tangent(&self, image: f64) -> f64 {
        self.lens.tangent(image)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_distinct(distortion: [f64; 2], field_of_view_deg: f64) -> bool {
        let field_of_view_deg = Some([field_of_view_deg; 2]);
        let keys = Array { rows: 2, columns: 2, field_of_view_deg, distortion, ..Array::default() };
        Projection::of(&keys, 21.0).is_distinct()
    }

    #[test]
    fn a_lens_that_images_two_directions_at_one_place_is_known() {
        assert!(is_distinct([0.0, 0.0], 170.0));
        assert!(is_distinct([-0.3, 0.1], 60.0) && is_distinct([0.4, 0.0], 60.0));
        assert!(!is_distinct([-2.0, 0.0], 70.0));
    }

    #[test]
    fn a_direction_is_that_of_its_image() {
        let lens = Distortion([-0.2, 0.05]);
        for tangent in [0.0, 1e-9, 0.1, 0.5, 0.8] {
            assert!((lens.tangent(lens.image(tangent)) - tangent).abs() < 1e-14);
        }
    }
}
