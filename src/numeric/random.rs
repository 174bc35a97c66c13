//! Random numbers that follow from a seed, the same on every platform: ChaCha (Bernstein 2008) with eight rounds.
//!
//! One block at a time in a loop: rand_chacha's four side by side give the same numbers, as a test shows, with five
//! times the code.

const WORDS: usize = 16;
/// "expand 32-byte k".
const CONSTANTS: [u32; 4] = [0x6170_7865, 0x3320_646e, 0x7962_2d32, 0x6b20_6574];
const DOUBLE_ROUNDS: usize = 4;
/// Columns, then diagonals.
const QUARTERS: [[usize; 4]; 8] = [
    [0, 4, 8, 12],
    [1, 5, 9, 13],
    [2, 6, 10, 14],
    [3, 7, 11, 15],
    [0, 5, 10, 15],
    [1, 6, 11, 12],
    [2, 7, 8, 13],
    [3, 4, 9, 14],
];

/// A stream of random numbers.
pub(crate) struct Random {
    state: [u32; WORDS],
    block: [u32; WORDS],
    /// How many words of the block are taken.
    taken: usize,
}

impl Random {
    /// The numbers of one seed fall into streams that have nothing to do with each other.
    pub fn new(mut seed: u64, stream: u64) -> Self {
        let mut state = [0; WORDS];
        state[..4].copy_from_slice(&CONSTANTS);
        for word in &mut state[4..12] {
            // PCG32 (O'Neill 2014), as rand_core expands a seed.
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(11_634_580_027_462_260_723);
            *word = ((((seed >> 18) ^ seed) >> 27) as u32).rotate_right((seed >> 59) as u32);
        }
        (state[14], state[15]) = (stream as u32, (stream >> 32) as u32);
        Self { state, block: state, taken: WORDS }
    }

    /// 32 random bits.
    pub fn word(&mut self) -> u32 {
        if self.taken == WORDS {
            self.next_block();
        }
        self.taken += 1;
        self.block[self.taken - 1]
    }

    /// Evenly over [0, 1), with 53 bits.
    pub fn uniform(&mut self) -> f64 {
        let low = u64::from(self.word());
        ((low | u64::from(self.word()) << 32) >> 11) as f64 / (1_u64 << 53) as f64
    }

    #[inline(never)]
    fn next_block(&mut self) {
        let mut x = self.state;
        for [a, b, c, d] in [QUARTERS; DOUBLE_ROUNDS].into_iter().flatten() {
            for [to, from, turned, bits] in [[a, b, d, 16], [c, d, b, 12], [a, b, d, 8], [c, d, b, 7]] {
                x[to] = x[to].wrapping_add(x[from]);
                x[turned] = (x[turned] ^ x[to]).rotate_left(bits as u32);
            }
        }
        x.iter_mut().zip(&self.state).for_each(|(word, start)| *word = word.wrapping_add(*start));
        self.block = x;
        self.taken = 0;
        self.state[12] = self.state[12].wrapping_add(1);
        self.state[13] = self.state[13].wrapping_add(u32::from(self.state[12] == 0));
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    #[test]
    fn words_are_those_of_the_reference() {
        for (seed, stream) in [(0, 0), (7, 3), (u64::MAX, 1 << 40)] {
            let (mut random, mut reference) = (Random::new(seed, stream), ChaCha8Rng::seed_from_u64(seed));
            reference.set_stream(stream);
            assert!((0..1000).all(|_| random.word() == reference.next_u32()), "{seed}");
            random.state[12] = u32::MAX - 1;
            reference.set_word_pos((u128::from(u32::MAX) - 1) * WORDS as u128);
            random.taken = WORDS;
            for _ in 0..100 {
                assert_eq!(random.uniform(), (reference.next_u64() >> 11) as f64 / (1_u64 << 53) as f64);
            }
        }
    }
}
