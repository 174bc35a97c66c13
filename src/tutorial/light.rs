//! Chapter 2. What colour does a normal have?
//!
//! A Lambertian surface under distant light is described by nine spherical harmonics per channel. In the logarithm,
//!
//! > log S_j = nᵀ M_j n,  n = (n_x, n_y, n_z, 1)ᵀ  (Eq. 3)
//!
//! with a symmetric matrix M_j of the coefficients L₁ .. L₉ (Eq. 5). This is *linear in L*: if the normals are known,
//! the light is a least-squares fit. Where the normals are not enough, a prior over natural lights helps (Eq. 2):
//!
//! > h(L) = λ_L (L − μ)ᵀ Σ⁻¹ (L − μ)
//!
//! [`Light::shade`](crate::Light::shade) is Eq. 3, and [`LightFitter`](crate::LightFitter) is the fit.
//!
//! ```
//! use bimodal_stereo::{ColourView, LightFitter, LightPrior, scenes};
//!
//! let sample = scenes::Scene::new(&scenes::surface("bust")?)?.sample(&scenes::SampleRequest::default())?;
//! let image = ColourView::new(sample.colour_image())?;
//! let log = [&image.log[0][..], &image.log[1], &image.log[2]];
//!
//! // With the scene's true normals and hardly any prior, the fit returns the light.
//! let fit = LightFitter::default().fit(&sample.truth.image_normals, log, &LightPrior::natural(), 1e-9)?;
//! let normal = [0.6, 0.0, -0.8];
//! for (found, truth) in fit.light.shade(normal).into_iter().zip(sample.light.shade(normal)) {
//!     assert!((found - truth).abs() < 0.02);
//! }
//! # Ok::<(), bimodal_stereo::Error>(())
//! ```
