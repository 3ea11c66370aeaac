//! The processes started by `mpirun`, as ranks of the library.

use asperity_base::ranks::Ranks;
use mpi::Count;
use mpi::datatype::PartitionMut;
use mpi::request;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives, Destination, Equivalence, Source};

/// All processes of `MPI_COMM_WORLD`.
pub(crate) struct World {
    rank: usize,
    count: usize,
}

impl World {
    /// Creates the view of this process, once MPI is initialised.
    pub(crate) fn new() -> Self {
        let world = SimpleCommunicator::world();
        Self { rank: world.rank() as usize, count: world.size() as usize }
    }

    /// Sends each other rank its part and receives one from it; the own part is copied.
    fn exchange_parts<T: Equivalence + Copy>(
        &self,
        mut sent: &[T],
        sent_counts: &[usize],
        mut received: &mut [T],
        received_counts: &[usize],
    ) {
        let world = SimpleCommunicator::world();
        let process = |rank: usize| world.process_at_rank(rank as Count);
        let mut own = None;
        let (mut to, mut from) = (Vec::new(), Vec::new());
        for (rank, (&out, &back)) in sent_counts.iter().zip(received_counts).enumerate() {
            let (part, others) = sent.split_at(out);
            sent = others;
            let (room, others) = received.split_at_mut(back);
            received = others;
            if rank == self.rank {
                own = Some((part, room));
                continue;
            }
            // Messages between two ranks arrive in the order in which they are sent; an empty part has no
            // message.
            to.extend(part.chunks(MAX_MESSAGE).map(|message| (process(rank), message)));
            from.extend(room.chunks_mut(MAX_MESSAGE).map(|message| (process(rank), message)));
        }
        request::scope(|scope| {
            let receives: Vec<_> =
                from.into_iter().map(|(process, room)| process.immediate_receive_into(scope, room)).collect();
            let sends: Vec<_> =
                to.iter().map(|(process, part)| process.immediate_send(scope, *part)).collect();
            if let Some((part, room)) = own {
                room.copy_from_slice(part);
            }
            receives.into_iter().for_each(request::Request::wait_without_status);
            sends.into_iter().for_each(request::Request::wait_without_status);
        });
    }
}

impl Ranks for World {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.count
    }

    fn gather(&self, numbers: &[f64], counts: &[usize]) -> Vec<f64> {
        let mut gathered = vec![0.0; counts.iter().sum()];
        let counts: Vec<Count> = counts.iter().map(|count| as_count(*count)).collect();
        let firsts = counts.iter().scan(0, |next, count| {
            let first = *next;
            *next += count;
            Some(first)
        });
        let firsts: Vec<Count> = firsts.collect();
        let mut parts = PartitionMut::new(&mut gathered[..], counts, firsts);
        SimpleCommunicator::world().all_gather_varcount_into(numbers, &mut parts);
        gathered
    }

    fn exchange(&self, sent: &[f64], out: &[usize], received: &mut [f64], back: &[usize]) {
        self.exchange_parts(sent, out, received, back);
    }

    fn exchange_single(&self, sent: &[f32], out: &[usize], received: &mut [f32], back: &[usize]) {
        self.exchange_parts(sent, out, received, back);
    }
}

/// Largest number of values in a message: MPI counts up to 2³¹.
const MAX_MESSAGE: usize = 1 << 30;

/// Converts a count to the type of MPI.
fn as_count(count: usize) -> Count {
    Count::try_from(count).expect("fewer than 2³¹ numbers at once: more ranks take less each")
}
