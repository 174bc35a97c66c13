//! Results of tasks that several workers share. They arrive in any order and are used in the order of the tasks.

/// The state of each task.
#[derive(Debug)]
pub struct TaskResults<T>(Vec<TaskState<T>>);

#[derive(Clone, Copy, Debug, PartialEq)]
enum TaskState<T> {
    Open,
    /// The task has been given to a worker.
    Taken,
    Done(T),
}

impl<T> TaskResults<T> {
    pub fn new(count: usize) -> Self {
        Self((0..count).map(|_| TaskState::Open).collect())
    }

    /// The first open task for which `is_wanted` holds, to be given to a worker.
    pub fn take(&mut self, is_wanted: impl Fn(usize) -> bool) -> Option<usize> {
        let index = self.first_open(is_wanted)?;
        self.0[index] = TaskState::Taken;
        Some(index)
    }

    /// The task for this thread: the first open one, otherwise the last one that a worker has not returned. Workers
    /// take the first tasks first, so the last is the least likely to be in progress. This thread never waits for a worker.
    pub fn next(&self, is_wanted: impl Fn(usize) -> bool) -> Option<usize> {
        self.first_open(&is_wanted).or_else(|| {
            let is_taken = |state: &TaskState<T>| matches!(state, TaskState::Taken);
            (0..self.0.len()).rev().find(|&index| is_taken(&self.0[index]) && is_wanted(index))
        })
    }

    fn first_open(&self, is_wanted: impl Fn(usize) -> bool) -> Option<usize> {
        (0..self.0.len()).find(|&index| matches!(self.0[index], TaskState::Open) && is_wanted(index))
    }

    /// Stores the first result of a task; later ones are the same.
    pub fn put(&mut self, index: usize, result: T) {
        if let Some(state @ (TaskState::Open | TaskState::Taken)) = self.0.get_mut(index) {
            *state = TaskState::Done(result);
        }
    }

    pub fn get(&self, index: usize) -> Option<&T> {
        match self.0.get(index)? {
            TaskState::Done(result) => Some(result),
            TaskState::Open | TaskState::Taken => None,
        }
    }

    pub const fn len(&self) -> usize {
        self.0.len()
    }

    /// Number of tasks that are done.
    pub fn done(&self) -> usize {
        self.results().count()
    }

    pub fn is_complete(&self) -> bool {
        self.done() == self.len()
    }

    /// Available results, in the order of the tasks.
    pub fn results(&self) -> impl Iterator<Item = &T> {
        (0..self.len()).filter_map(|index| self.get(index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_in_any_order_are_used_in_the_order_of_tasks() {
        let mut tasks = TaskResults::new(4);
        assert_eq!((tasks.take(|_| true), tasks.take(|index| index != 1)), (Some(0), Some(2)));
        tasks.put(2, 'c');
        assert_eq!(tasks.next(|_| true), Some(1));
        tasks.put(1, 'b');
        tasks.put(3, 'd');
        assert!(!tasks.is_complete());
        // No worker has returned the first task, so it is done here; a later result is the same and ignored.
        assert_eq!(tasks.next(|_| true), Some(0));
        tasks.put(0, 'a');
        tasks.put(0, 'x');
        tasks.put(9, 'x');
        assert!(tasks.is_complete() && tasks.next(|_| true).is_none());
        assert_eq!(tasks.results().collect::<String>(), "abcd");
    }
}
