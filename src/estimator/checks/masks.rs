//! Whether a mask is missing, so that the pose may be that of something else.

use crate::estimator::pair::ViewPair;
use crate::options::Start;
use crate::reason::Reason;

/// Share of the depths that trimming may leave out of a map without a mask. Of two whole frames of a table with an object it left out 40
/// and 45 %, the object among them, and the wall had a pose 56 to 94 degrees off that seemed sure; of 79 renders with a second object,
/// which seemed sure as well, less than this.
const LARGEST_TRIMMED: f64 = 0.15;

/// Of a depth map of which much was trimmed, or of a whole frame that a pose was searched for.
pub fn missing_mask(pair: &ViewPair) -> Option<Reason> {
    let is_whole_frame = pair.options.start == Start::Search && pair.image.is_whole_frame();
    reason(pair.depth.trimmed_without_mask(), is_whole_frame)
}

fn reason(trimmed: f64, is_whole_frame: bool) -> Option<Reason> {
    if trimmed > LARGEST_TRIMMED {
        return Some(Reason::MissingDepthMask { percent: 100.0 * trimmed });
    }
    is_whole_frame.then_some(Reason::MissingImageMask)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flying_pixels_may_be_trimmed_and_an_object_may_not() {
        assert_eq!([0.0, 0.05].map(|trimmed| reason(trimmed, false)), [None, None]);
        assert_eq!(reason(0.4, false), Some(Reason::MissingDepthMask { percent: 40.0 }));
        assert_eq!(reason(0.0, true), Some(Reason::MissingImageMask));
    }
}
