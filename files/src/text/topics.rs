//! Names of cameras from the topics of their images: Kalibr's cam0 is called "color" if its topic is /color/image_raw.

use super::calibration::Calibration;

/// Parts of topics that do not distinguish cameras: the kind of message, and whether it was rectified.
const MESSAGES: [&str; 8] =
    ["/image", "/compressed", "/image_raw", "/image_rect", "/image_rect_raw", "/image_color", "/image_mono", "/raw"];
/// Largest number of characters of a topic.
const LONGEST: usize = 80;

/// A topic without the kind of its messages and its first slash.
fn called(topic: &str) -> String {
    let topic: String = topic.trim().chars().take(LONGEST).collect();
    let mut name = topic.trim_end_matches('/');
    let rest = |name: &str| {
        let is_end = |kind: &&&str| {
            let start = name.len().checked_sub(kind.len());
            start.and_then(|start| name.get(start..)).is_some_and(|end| end.eq_ignore_ascii_case(kind))
        };
        MESSAGES.iter().find(is_end).map(|kind| name.len() - kind.len())
    };
    while let Some(length) = rest(name) {
        name = &name[..length];
    }
    name.trim_start_matches('/').to_owned()
}

fn is_numbered(camera: &str) -> bool {
    let digits = camera.get(3..).filter(|_| camera.get(..3).is_some_and(|start| start.eq_ignore_ascii_case("cam")));
    digits.is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|letter| letter.is_ascii_digit()))
}

/// Names cameras that are only numbered, and the ends of poses, after the topics of their images: pairs of camera and
/// topic.
pub fn by_topics(topics: &[(String, String)], found: &mut Calibration) {
    let names: Vec<(&str, String)> = topics.iter().map(|(camera, topic)| (camera.as_str(), called(topic))).collect();
    let is_own = |index: usize| names[..index].iter().all(|(_, name)| *name != names[index].1);
    let is_clear = (0..names.len()).all(|index| is_own(index) && !names[index].1.is_empty());
    if !is_clear || !names.iter().all(|(camera, _)| is_numbered(camera)) {
        return;
    }
    let renamed = |name: &Option<String>| {
        let topic = names.iter().find(|(camera, _)| Some(*camera) == name.as_deref());
        topic.map(|(_, name)| name.clone()).or_else(|| name.clone())
    };
    for camera in &mut found.cameras {
        camera.name = renamed(&camera.name);
    }
    for pose in &mut found.poses {
        let (from, to) = (renamed(&pose.names.from), renamed(&pose.names.to));
        if from == pose.names.from && to == pose.names.to {
            continue;
        }
        let end = |name: &Option<String>| name.clone().unwrap_or_default();
        pose.names.name = Some(format!("{} from {}", end(&to), end(&from)));
        (pose.names.from, pose.names.to) = (from, to);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn topics_are_called_without_the_kind_of_their_messages() {
        for (topic, name) in [
            ("/color/image_raw", "color"),
            ("/camera/infra1/image_rect_raw/compressed", "camera/infra1"),
            ("cam/IMAGE/", "cam"),
            ("/image_raw", ""),
        ] {
            assert_eq!(called(topic), name, "{topic}");
        }
        assert!(is_numbered("cam12") && is_numbered("CAM0") && !is_numbered("cam") && !is_numbered("camera1"));
    }
}
