//! Files that are not read. They are recognised by their first bytes and reported with advice.

/// First bytes of picture formats that are not supported, with advice.
const PICTURES: [(usize, &[u8], &str); 7] = [
    (0, b"GIF8", "a GIF; save it as PNG"),
    (0, b"BM", "a BMP; save it as PNG"),
    (4, b"ftyphei", "HEIC or AVIF; save it as PNG or JPEG"),
    (4, b"ftypmif1", "HEIC or AVIF; save it as PNG or JPEG"),
    (4, b"ftypavif", "HEIC or AVIF; save it as PNG or JPEG"),
    (0, b"\xff\x4f\xff\x51", "JPEG 2000; save it as PNG"),
    (8, b"WEBP", "WebP; save it as PNG"),
];

/// First bytes of other files that are not supported, with advice.
const OTHERS: [(usize, &[u8], &str); 10] = [
    (0, b"PK\x03\x04", "a ZIP archive (.npz is one); unpack it first"),
    (0, b"\x1f\x8b", "compressed by gzip; unpack it first"),
    (0, b"\x89HDF", "HDF5; save the array as .npy"),
    (0, b"MATLAB", "a .mat file of MATLAB; save the array as .npy or 16-bit PNG"),
    (4, b"ftyp", "a video; save its frames as PNG"),
    (8, b"AVI ", "a video; save its frames as PNG"),
    (0, b"#ROSBAG", "a recording of ROS; export its images and camera_info first"),
    (0, b"SQLite format", "a recording of ROS; export its images and camera_info first"),
    (0, b"\x89MCAP", "a recording of ROS; export its images and camera_info first"),
    (0, b"%PDF", "a PDF"),
];

/// Formats of pixels and points that only the npm package reads.
const ELSEWHERE: [(usize, &[u8], &str); 12] = [
    (0, b"II*\0", "TIFF"),
    (0, b"MM\0*", "TIFF"),
    (0, b"II+\0", "BigTIFF"),
    (0, b"\x76\x2f\x31\x01", "OpenEXR"),
    (0, b"Pf", "PFM"),
    (0, b"PF", "PFM"),
    (0, b"P2", "PGM"),
    (0, b"P3", "PPM"),
    (0, b"P5", "PGM"),
    (0, b"P6", "PPM"),
    (0, b"ply", "PLY"),
    (0, b"# .PCD", "PCD"),
];

fn kind_in(kinds: &'static [(usize, &'static [u8], &'static str)], bytes: &[u8]) -> Option<&'static str> {
    let is = |(at, start, _): &&(usize, &[u8], &str)| bytes.get(*at..).is_some_and(|rest| rest.starts_with(start));
    kinds.iter().find(is).map(|(_, _, name)| *name)
}

/// The format of a file of pixels or points that only the npm package reads.
pub fn read_elsewhere(bytes: &[u8]) -> Option<&'static str> {
    kind_in(&ELSEWHERE, bytes)
}

/// Whether the bytes begin a picture in a format that is not read here.
pub fn is_foreign_picture(bytes: &[u8]) -> bool {
    read_elsewhere(bytes).is_some() || kind_in(&PICTURES, bytes).is_some()
}

/// A description of the format that an unread file seems to have.
pub fn describe(bytes: &[u8]) -> String {
    if let Some(kind) = read_elsewhere(bytes) {
        return format!("it is {kind}, which is not supported here; npx bimodal-stereo check reads it");
    }
    match kind_in(&PICTURES, bytes).or_else(|| kind_in(&OTHERS, bytes)) {
        Some(kind) => format!("it is {kind}"),
        None => "its format is not supported".into(),
    }
}
