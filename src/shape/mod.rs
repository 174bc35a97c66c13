//! Shape of both views: normals from shading, heights from normals, refinement of the depth map.
