//! Results of tasks that several hands work on: they come in any order and are used in their own.

/// One place for the result of each task.
#[derive(Debug)]
pub struct Slots<T>(Vec<Slot<T>>);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Slot<T> {
    Open,
    /// Somebody else is at it.
    Taken,
    Done(T),
}

impl<T> Slots<T> {
    pub fn new(count: usize) -> Self {
        Self((0..count).map(|_| Slot::Open).collect())
    }

    /// The first task that nobody is at and that `is_wanted`, for somebody else to do.
    pub fn take(&mut self, is_wanted: impl Fn(usize) -> bool) -> Option<usize> {
        let index = self.first_open(is_wanted)?;
        self.0[index] = Slot::Taken;
        Some(index)
    }

    /// What to do here: the first task that nobody is at, or else the last one that others have not brought back. They
    /// begin with their first, so it is the least likely to be under way, and whoever never returns is not waited for.
    pub fn next(&self, is_wanted: impl Fn(usize) -> bool) -> Option<usize> {
        self.first_open(&is_wanted).or_else(|| {
            let is_taken = |slot: &Slot<T>| matches!(slot, Slot::Taken);
            (0..self.0.len()).rev().find(|&index| is_taken(&self.0[index]) && is_wanted(index))
        })
    }

    fn first_open(&self, is_wanted: impl Fn(usize) -> bool) -> Option<usize> {
        (0..self.0.len()).find(|&index| matches!(self.0[index], Slot::Open) && is_wanted(index))
    }

    /// Keeps the first result of a task: whoever does it gets the same.
    pub fn put(&mut self, index: usize, result: T) {
        if let Some(slot @ (Slot::Open | Slot::Taken)) = self.0.get_mut(index) {
            *slot = Slot::Done(result);
        }
    }

    pub fn get(&self, index: usize) -> Option<&T> {
        match self.0.get(index)? {
            Slot::Done(result) => Some(result),
            Slot::Open | Slot::Taken => None,
        }
    }

    pub const fn len(&self) -> usize {
        self.0.len()
    }

    /// How many are done.
    pub fn done(&self) -> usize {
        self.results().count()
    }

    pub fn is_complete(&self) -> bool {
        self.done() == self.len()
    }

    /// What is there, in the order of the tasks.
    pub fn results(&self) -> impl Iterator<Item = &T> {
        (0..self.len()).filter_map(|index| self.get(index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_order_of_hands_leaves_the_order_of_tasks() {
        let mut slots = Slots::new(4);
        assert_eq!((slots.take(|_| true), slots.take(|index| index != 1)), (Some(0), Some(2)));
        slots.put(2, 'c');
        assert_eq!(slots.next(|_| true), Some(1));
        slots.put(1, 'b');
        slots.put(3, 'd');
        assert!(!slots.is_complete());
        // Nobody has brought the first, so it is done here; what comes later is the same and ignored.
        assert_eq!(slots.next(|_| true), Some(0));
        slots.put(0, 'a');
        slots.put(0, 'x');
        slots.put(9, 'x');
        assert!(slots.is_complete() && slots.next(|_| true).is_none());
        assert_eq!(slots.results().collect::<String>(), "abcd");
    }
}
