//! Ranks as threads of one process.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};

use super::{Number, Ranks};

/// Runs a `task` on each of `count` ranks; returns its results in rank order.
pub fn on_ranks<R: Send>(count: usize, task: impl Fn(Arc<dyn Ranks>) -> R + Sync) -> Vec<R> {
    let mut ends: Vec<Vec<_>> = (0..count).map(|_| (0..count).map(|_| None).collect()).collect();
    let mut senders: Vec<Vec<_>> = (0..count).map(|_| Vec::new()).collect();
    for (from, senders) in senders.iter_mut().enumerate() {
        for end in &mut ends {
            let (sender, receiver) = channel();
            senders.push(sender);
            end[from] = Some(receiver);
        }
    }
    std::thread::scope(|scope| {
        let ranks = senders.into_iter().zip(ends).enumerate().map(|(rank, (to, from))| Thread {
            rank,
            to: to.into_iter().map(Mutex::new).collect(),
            from: from.into_iter().map(|end| Mutex::new(end.expect("an end for each"))).collect(),
        });
        let task = &task;
        let ranks: Vec<_> = ranks.map(|rank| scope.spawn(move || task(Arc::new(rank)))).collect();
        ranks.into_iter().map(|rank| rank.join().expect("no rank panics")).collect()
    })
}

/// One of the ranks: a channel to and from each rank. Single-precision numbers are sent as double, without
/// loss.
struct Thread {
    rank: usize,
    to: Vec<Mutex<Sender<Vec<f64>>>>,
    from: Vec<Mutex<Receiver<Vec<f64>>>>,
}

impl Thread {
    fn send(&self, to: usize, numbers: Vec<f64>) {
        self.to[to].lock().unwrap().send(numbers).expect("the other rank is there");
    }

    fn receive(&self, from: usize) -> Vec<f64> {
        self.from[from].lock().unwrap().recv().expect("the other rank is there")
    }

    fn exchange_numbers<T: Number + Into<f64>>(
        &self,
        sent: &[T],
        sent_counts: &[usize],
        received: &mut [T],
        received_counts: &[usize],
        narrowed: impl Fn(f64) -> T,
    ) {
        assert_eq!(sent.len(), sent_counts.iter().sum::<usize>(), "numbers sent");
        let mut rest = sent;
        for (to, count) in sent_counts.iter().enumerate() {
            let (part, others) = rest.split_at(*count);
            self.send(to, part.iter().map(|value| (*value).into()).collect());
            rest = others;
        }
        let mut rest = received;
        for (from, count) in received_counts.iter().enumerate() {
            let numbers = self.receive(from);
            assert_eq!(numbers.len(), *count, "numbers that rank {from} sends to {}", self.rank);
            let (part, others) = rest.split_at_mut(*count);
            part.iter_mut().zip(numbers).for_each(|(value, number)| *value = narrowed(number));
            rest = others;
        }
        assert!(rest.is_empty(), "numbers received");
    }
}

impl Ranks for Thread {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.to.len()
    }

    fn gather(&self, numbers: &[f64], counts: &[usize]) -> Vec<f64> {
        (0..self.count()).for_each(|to| self.send(to, numbers.to_vec()));
        let gathered: Vec<Vec<f64>> = (0..self.count()).map(|from| self.receive(from)).collect();
        assert!(gathered.iter().map(Vec::len).eq(counts.iter().copied()), "numbers gathered");
        gathered.concat()
    }

    fn exchange(&self, sent: &[f64], out: &[usize], received: &mut [f64], back: &[usize]) {
        self.exchange_numbers(sent, out, received, back, |number| number);
    }

    fn exchange_single(&self, sent: &[f32], out: &[usize], received: &mut [f32], back: &[usize]) {
        self.exchange_numbers(sent, out, received, back, |number| number as f32);
    }
}
