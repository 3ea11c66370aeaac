//! Who computes which case: claims, files that only one process can make.
//!
//! The claim of case 3 is the file `claims/0003-1`, made in the way in which of many processes one succeeds. It is written again
//! and again while its case runs. Where it has not been for longer than it takes to be stale, or where its process has gone from
//! this machine, whoever comes makes `claims/0003-2`, and only one does; the owner of the first, should it live on, finds that
//! out when it renews. A claim goes when its case is done; that is told by the results, never by a claim.
//!
//! Two claims of a case that are made at the same time see each other: after making one, a process looks for others, and gives way.
//! Ages are told by the clock of the file system alone, so that clocks of machines may differ.

use std::fs::{self, File, TryLockError};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use serde::{Deserialize, Serialize};

use super::plan::name;
use crate::error::{Error, Result};
use crate::io::regular;

/// A process that computes cases.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Worker {
    /// The machine: the same for all processes that share its kernel, and for no others.
    pub machine: String,
    /// The process, to be told to people.
    pub process: String,
}

/// Who holds a claim, as far as it says.
#[derive(Debug, Clone, PartialEq)]
pub struct Holder {
    /// The process; none while the claim is being made.
    pub worker: Option<Worker>,
    /// Time since it was renewed.
    pub age: Duration,
    /// Whether it is another's to take.
    pub is_stale: bool,
}

/// The claims of a study.
#[derive(Debug)]
pub(super) struct Claims {
    folder: PathBuf,
    look: Look,
    held: Arc<Mutex<Vec<Arc<Held>>>>,
    /// Ends the thread that renews.
    _renewing: Sender<()>,
}

/// A claim of this process; the case is another's once it is dropped.
#[derive(Debug)]
pub(super) struct Claim {
    held: Arc<Held>,
    all: Arc<Mutex<Vec<Arc<Held>>>>,
}

#[derive(Debug)]
struct Held {
    path: PathBuf,
    file: Mutex<File>,
    content: Vec<u8>,
    lost: AtomicBool,
}

/// What becomes of an attempt to claim a case.
#[derive(Debug)]
pub(super) enum Attempt {
    Ours(Claim),
    Theirs,
}

/// What stands in a claim.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Content {
    #[serde(flatten)]
    worker: Worker,
    /// Different for each claim that a process makes.
    number: u64,
    /// Whether the operating system holds a lock on the file for as long as the process lives.
    locked: bool,
}

/// How long the lock of a claim is waited for: others look at it for a moment.
const PATIENCE: Duration = Duration::from_secs(1);
/// Renewals within the time that it takes to be stale.
const RENEWALS: u32 = 6;
/// The longest time between renewals.
const MAX_INTERVAL: Duration = Duration::from_secs(60);

impl Claims {
    /// The claims in `folder`, which is made where it is missing.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::NotExclusive`] where two processes could make one file.
    pub(super) fn enter(folder: &Path, worker: Worker, stale_after: Duration) -> Result<Self> {
        let failed = |source| Error::File { path: folder.to_owned(), source };
        fs::create_dir_all(folder).map_err(failed)?;
        if !is_exclusive(folder, create).map_err(failed)? {
            return Err(Error::NotExclusive { path: folder.to_owned() });
        }
        let held = Arc::<Mutex<Vec<Arc<Held>>>>::default();
        let renewing = renew_again_and_again(&held, (stale_after / RENEWALS).min(MAX_INTERVAL));
        let look = Look { clock: Clock::of(folder), worker, stale_after };
        Ok(Self { folder: folder.to_owned(), look, held, _renewing: renewing })
    }

    /// Tries to claim a case. What is claimed may be done meanwhile: who succeeds looks again.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(super) fn claim(&self, case: usize) -> Result<Attempt> {
        loop {
            match self.try_once(case)? {
                Some(attempt) => return Ok(attempt),
                // Whoever gave way as well waits for another time.
                None => thread::sleep(Duration::from_micros(200 + any_below(20_000))),
            }
        }
    }

    /// One attempt; none where it gave way to another one that was made at the same time.
    fn try_once(&self, case: usize) -> Result<Option<Attempt>> {
        let failed = |source| Error::File { path: self.folder.clone(), source };
        let before = self.generations(case).map_err(failed)?;
        if self.any_lives(case, &before).map_err(failed)? {
            return Ok(Some(Attempt::Theirs));
        }
        let generation = before.iter().max().map_or(1, |last| last + 1);
        let path = self.path(case, generation);
        let mut file = match create(&path) {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::AlreadyExists => return Ok(Some(Attempt::Theirs)),
            Err(source) => return Err(Error::File { path, source }),
        };
        let content = Content { worker: self.look.worker.clone(), number: counted(), locked: lock(&file) };
        let content = serde_json::to_vec(&content).expect("names can be written");
        if let Err(source) = file.write_all(&content) {
            let _ = fs::remove_file(&path);
            return Err(Error::File { path, source });
        }
        // Whoever makes another one from now on will see this one; who has made one before is seen here, also under the name
        // of one that was stale and has gone.
        let mut others = self.generations(case).map_err(failed)?;
        others.retain(|other| *other != generation);
        if self.any_lives(case, &others).map_err(failed)? {
            drop(file);
            let _ = fs::remove_file(&path);
            return Ok(None);
        }
        for stale in others {
            let _ = fs::remove_file(self.path(case, stale));
        }
        let held = Arc::new(Held { path, file: Mutex::new(file), content, lost: AtomicBool::new(false) });
        guarded(&self.held).push(held.clone());
        Ok(Some(Attempt::Ours(Claim { held, all: self.held.clone() })))
    }

    /// Whether one of these claims of a case is not another's to take.
    fn any_lives(&self, case: usize, generations: &[u64]) -> io::Result<bool> {
        for generation in generations {
            if self.look.at(&self.path(case, *generation))?.is_some_and(|holder| !holder.is_stale) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The time by the clock of the file system.
    pub(super) fn now(&self) -> SystemTime {
        self.look.clock.now()
    }

    fn path(&self, case: usize, generation: u64) -> PathBuf {
        self.folder.join(format!("{}-{generation}", name(case)))
    }

    /// Which claims of a case there are.
    fn generations(&self, case: usize) -> io::Result<Vec<u64>> {
        let all = all(&self.folder)?;
        Ok(all.into_iter().filter(|(other, _)| *other == case).map(|(_, generation)| generation).collect())
    }
}

/// The cases that are claimed, and by whom, as this process sees it.
pub(super) fn holders(
    folder: &Path,
    worker: &Worker,
    stale_after: Duration,
) -> io::Result<Vec<(usize, Holder)>> {
    let look = Look { clock: Clock::of(folder), worker: worker.clone(), stale_after };
    let mut found: Vec<(usize, u64)> = match all(folder) {
        Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
        all => all?,
    };
    found.sort_unstable();
    let holder = |(case, generation): (usize, u64)| {
        let holder = look.at(&folder.join(format!("{}-{generation}", name(case))));
        Ok(holder?.map(|holder| (case, holder)))
    };
    found.into_iter().filter_map(|claim| holder(claim).transpose()).collect()
}

/// All claims in a folder: case and generation.
fn all(folder: &Path) -> io::Result<Vec<(usize, u64)>> {
    let mut claims = Vec::new();
    for entry in fs::read_dir(folder)? {
        let name = entry?.file_name();
        let numbers = name.to_str().and_then(|name| name.split_once('-'));
        claims.extend(
            numbers.and_then(|(case, generation)| Some((case.parse().ok()?, generation.parse().ok()?))),
        );
    }
    Ok(claims)
}

/// What a process sees of claims.
#[derive(Debug)]
struct Look {
    clock: Clock,
    worker: Worker,
    stale_after: Duration,
}

impl Look {
    /// Who holds a claim; none where it has gone.
    fn at(&self, path: &Path) -> io::Result<Option<Holder>> {
        let mut file = match regular::open(path, "a claim") {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            file => file?,
        };
        let mut text = Vec::new();
        file.read_to_end(&mut text)?;
        let content: Option<Content> = serde_json::from_slice(&text).ok();
        let renewed = file.metadata()?.modified()?;
        // On another machine locks may be out of sight, or outlive their process.
        let here = content.as_ref().is_some_and(|of| of.locked && of.worker.machine == self.worker.machine);
        let now = if here { SystemTime::now() } else { self.clock.now() };
        let age = now.duration_since(renewed).unwrap_or_default();
        let is_stale = match file.try_lock() {
            Ok(()) if here => true,
            Err(TryLockError::WouldBlock) if here => false,
            _ => age > self.stale_after,
        };
        Ok(Some(Holder { worker: content.map(|content| content.worker), age, is_stale }))
    }
}

/// The clock of a file system, read from a file now and then.
#[derive(Debug)]
struct Clock {
    folder: PathBuf,
    read: Mutex<Option<(Instant, SystemTime)>>,
}

impl Clock {
    fn of(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), read: Mutex::default() }
    }

    fn now(&self) -> SystemTime {
        /// How long the clock of this machine keeps step with it.
        const STEADY: Duration = Duration::from_secs(60);
        let mut read = guarded(&self.read);
        if read.is_none_or(|(at, _)| at.elapsed() > STEADY) {
            // Where nothing can be written the clock of this machine must do.
            *read = Some((Instant::now(), self.ask().unwrap_or_else(|_| SystemTime::now())));
        }
        let (at, time) = read.expect("it has just been read");
        time + at.elapsed()
    }

    fn ask(&self) -> io::Result<SystemTime> {
        let mut file = tempfile::Builder::new().prefix(".now-").tempfile_in(&self.folder)?;
        file.write_all(b"now")?;
        file.as_file().sync_data()?;
        file.as_file().metadata()?.modified()
    }
}

impl Claim {
    /// Whether another process has taken the case over, since this one was not heard of for too long.
    pub(super) fn is_lost(&self) -> bool {
        self.held.lost.load(Ordering::Relaxed)
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        guarded(&self.all).retain(|held| !Arc::ptr_eq(held, &self.held));
        if self.held.is_there() {
            let _ = fs::remove_file(&self.held.path);
        }
    }
}

impl Held {
    /// Whether the file is still the one that this process has made.
    fn is_there(&self) -> bool {
        regular::read(&self.path, "a claim", u64::MAX).is_ok_and(|content| content == self.content)
    }

    /// Writes the claim again, so that it is young; it is lost once it is not there, or a later one is.
    fn renew(&self) {
        let later = || {
            let name = self.path.file_name()?.to_str()?;
            let (case, generation) = name.split_once('-')?;
            let next = generation.parse::<u64>().ok()? + 1;
            Some(self.path.with_file_name(format!("{case}-{next}")).exists())
        };
        if !self.is_there() || later() == Some(true) {
            self.lost.store(true, Ordering::Relaxed);
            return;
        }
        let mut file = guarded(&self.file);
        // Where that fails, it grows old, and the case another's.
        let _ = file.rewind().and_then(|()| file.write_all(&self.content)).and_then(|()| file.sync_data());
    }
}

/// A thread that renews what is held, until the sender goes.
fn renew_again_and_again(held: &Arc<Mutex<Vec<Arc<Held>>>>, interval: Duration) -> Sender<()> {
    let (renewing, ended) = mpsc::channel();
    let held = held.clone();
    thread::spawn(move || {
        while ended.recv_timeout(interval) == Err(RecvTimeoutError::Timeout) {
            let held: Vec<_> = guarded(&held).clone();
            held.iter().for_each(|held| held.renew());
        }
    });
    renewing
}

/// Makes a file that is not there, which of many processes one does.
fn create(path: &Path) -> io::Result<File> {
    File::options().write(true).create_new(true).open(path)
}

/// Whether a file that `create` makes in a folder cannot be made a second time.
fn is_exclusive(folder: &Path, create: impl Fn(&Path) -> io::Result<File>) -> io::Result<bool> {
    let made = tempfile::Builder::new().prefix(".probe-").make_in(folder, &create);
    match made {
        Err(error) if matches!(error.kind(), ErrorKind::Unsupported | ErrorKind::InvalidInput) => Ok(false),
        made => Ok(matches!(create(made?.path()), Err(error) if error.kind() == ErrorKind::AlreadyExists)),
    }
}

/// Locks a file for as long as it is open; whether the file system has locks.
fn lock(file: &File) -> bool {
    let began = Instant::now();
    loop {
        match file.try_lock() {
            Ok(()) => return true,
            Err(TryLockError::Error(_)) => return false,
            Err(TryLockError::WouldBlock) if began.elapsed() < PATIENCE => thread::sleep(PATIENCE / 500),
            Err(TryLockError::WouldBlock) => return false,
        }
    }
}

/// A number that a process gives once.
fn counted() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Some number below another, not the same in two processes.
fn any_below(limit: u64) -> u64 {
    let seed = RandomState::new().build_hasher().finish();
    seed % limit
}

fn guarded<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claims(folder: &Path, machine: &str, stale_after: Duration) -> Claims {
        let worker = Worker { machine: machine.to_owned(), process: "1".to_owned() };
        Claims::enter(folder, worker, stale_after).unwrap()
    }

    fn ours(attempt: Attempt) -> Option<Claim> {
        if let Attempt::Ours(claim) = attempt { Some(claim) } else { None }
    }

    #[test]
    fn of_many_that_want_a_case_one_has_it_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let inside = AtomicU64::new(0);
        let taken = AtomicU64::new(0);
        thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    let claims = claims(folder.path(), "a", Duration::from_secs(60));
                    for _ in 0..100 {
                        if let Some(claim) = ours(claims.claim(7).unwrap()) {
                            assert_eq!(inside.fetch_add(1, Ordering::SeqCst), 0);
                            taken.fetch_add(1, Ordering::SeqCst);
                            thread::yield_now();
                            assert!(!claim.is_lost());
                            inside.fetch_sub(1, Ordering::SeqCst);
                        }
                    }
                });
            }
        });
        assert!(taken.load(Ordering::SeqCst) > 0);
        assert!(all(folder.path()).unwrap().is_empty(), "claims go when they are dropped");
    }

    #[test]
    fn a_claim_is_renewed_while_it_is_held_and_taken_over_when_it_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let stale_after = Duration::from_millis(300);
        let first = claims(folder.path(), "a", stale_after);
        let held = ours(first.claim(3).unwrap()).unwrap();
        // Another machine, where its lock says nothing.
        let second = claims(folder.path(), "b", stale_after);
        let began = Instant::now();
        while began.elapsed() < 3 * stale_after {
            assert!(ours(second.claim(3).unwrap()).is_none(), "it lives");
            thread::sleep(stale_after / 10);
        }
        assert!(!held.is_lost());
        // As if its process had been stopped: nothing renews it any more.
        guarded(&first.held).clear();
        thread::sleep(2 * stale_after);
        let taken = ours(second.claim(3).unwrap()).expect("it is stale");
        held.held.renew();
        assert!(held.is_lost() && !taken.is_lost());
        // Who has lost it takes nothing away.
        drop(held);
        assert_eq!(all(folder.path()).unwrap(), [(3, 2)]);
        assert!(ours(first.claim(3).unwrap()).is_none());
        drop(taken);
        assert!(ours(first.claim(3).unwrap()).is_some());
    }

    #[test]
    fn on_one_machine_a_process_that_has_gone_is_missed_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let gone = Content {
            worker: Worker { machine: "a".to_owned(), process: "9".to_owned() },
            number: 0,
            locked: true,
        };
        fs::write(folder.path().join("0003-1"), serde_json::to_vec(&gone).unwrap()).unwrap();
        let elsewhere = claims(folder.path(), "b", Duration::from_secs(600));
        assert!(ours(elsewhere.claim(3).unwrap()).is_none(), "for who is elsewhere it is young");
        let here = claims(folder.path(), "a", Duration::from_secs(600));
        assert!(ours(here.claim(3).unwrap()).is_some());
    }

    #[test]
    fn a_file_system_in_which_two_make_one_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(is_exclusive(folder.path(), create).unwrap());
        let careless = |path: &Path| File::options().write(true).create(true).truncate(true).open(path);
        assert!(!is_exclusive(folder.path(), careless).unwrap());
        let unable = |_: &Path| Err(ErrorKind::Unsupported.into());
        assert!(!is_exclusive(folder.path(), unable).unwrap());
        assert!(is_exclusive(&folder.path().join("nowhere"), create).is_err());
    }
}
