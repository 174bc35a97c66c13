//! Arithmetic number by number, as [`lanes`](super::lanes) and [`doubles`](super::doubles) spell it out.

/// An operator of a vector, by the function of its `arch` with that name.
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

/// Functions of arrays that do one thing with each number: what `arch` has where there are no vectors.
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
