//! Random numbers from a seed, the same on every platform: ChaCha with eight rounds, by rand_chacha.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A stream of random numbers.
pub(crate) struct Random(ChaCha8Rng);

impl Random {
    /// One seed yields many independent streams.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self(generator)
    }

    /// 32 random bits.
    pub fn word(&mut self) -> u32 {
        self.0.next_u32()
    }

    /// Uniform over [0, 1), with 53 bits.
    pub fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every scene, search and verdict draws from these streams, so a release of the crate that changed them would
    /// change every published table.
    #[test]
    fn streams_stay_as_the_published_tables_have_them() {
        let known = [
            ((0, 0), [2_811_902_828, 3_045_455_719, 3_134_767_159], [0.507_364_684_358_686_5, 0.494_276_426_950_336]),
            ((7, 3), [2_257_105_521, 779_716_368, 2_242_456_910], [0.719_282_860_423_639_4, 0.643_895_494_828_208_3]),
            (
                (u64::MAX, 1 << 40),
                [3_954_669_208, 4_129_058_718, 2_660_776_892],
                [0.220_660_297_174_204_66, 0.004_813_489_054_268_483],
            ),
        ];
        for ((seed, stream), words, [early, late]) in known {
            let mut random = Random::new(seed, stream);
            assert_eq!([(); 3].map(|()| random.word()), words, "{seed}");
            assert_eq!(random.uniform(), early, "{seed}");
            // Ten more words, so that the next number takes one word of this block and one of the next.
            (0..10).for_each(|_| _ = random.word());
            assert_eq!(random.uniform(), late, "{seed}");
        }
    }
}
