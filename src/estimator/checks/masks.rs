//! Detects a missing mask, without which the pose may be that of something else.

use crate::estimator::pair::ViewPair;
use crate::options::Start;
use crate::reason::Reason;

/// Largest share of the depths that trimming may remove from a depth map without a mask. Flying pixels stay below it; a
/// whole frame with a background exceeds it. Set on whole frames of objects on a table (docs/lab/thresholds.md).
const LARGEST_TRIMMED: f64 = 0.15;

/// The reason to cap a verdict if trimming removed much of the depth map, or if the pose was searched for in a whole
/// frame.
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
