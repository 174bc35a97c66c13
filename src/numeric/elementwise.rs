//! Macros that define the arithmetic of [`lanes`](super::lanes) and [`doubles`](super::doubles) for each number.

/// Implements an operator of a vector type by the function of the same name in its module `arch`.
macro_rules! operator {
    ($type:ident, $name:ident, $method:ident) => {
        impl $name for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(arch::$method(self.0, other.0))
            }
        }
    };
}

/// Defines functions of arrays that treat each number alike, for the module `arch` on targets without vector
/// instructions.
#[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
macro_rules! each {
    ($($name:ident($a:ident $(, $b:ident)*: $from:ty) -> $to:ty { $body:expr })*) => {
        $(#[inline(always)]
        pub fn $name($a: $from $(, $b: $from)*) -> $to {
            std::array::from_fn(|lane| {
                let $a = $a[lane];
                $(let $b = $b[lane];)*
                $body
            })
        })*
    };
}
