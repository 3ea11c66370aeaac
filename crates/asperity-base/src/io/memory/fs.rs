//! Functions of [`std::fs`] for files in memory.
//!
//! A path is resolved by its text: `a/../b` is `b`, and all relative paths begin at the root.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

pub use std::fs::TryLockError;

/// Files and folders by path, without the root.
type Tree = BTreeMap<PathBuf, Node>;

static TREE: Mutex<Tree> = Mutex::new(Tree::new());

#[derive(Debug, Clone)]
enum Node {
    Folder,
    File(Arc<Content>),
}

#[derive(Debug)]
struct Content {
    bytes: Mutex<Vec<u8>>,
    modified: Mutex<SystemTime>,
    /// Number of changes of all files up to its last one.
    version: AtomicU64,
    locked: AtomicBool,
}

static CHANGES: AtomicU64 = AtomicU64::new(0);

impl Content {
    fn new(bytes: Vec<u8>) -> Self {
        let (modified, version) = (Mutex::new(now()), AtomicU64::new(next_version()));
        Self { bytes: Mutex::new(bytes), modified, version, locked: AtomicBool::new(false) }
    }

    fn change<T>(&self, task: impl FnOnce(&mut Vec<u8>) -> T) -> T {
        *guarded(&self.modified) = now();
        self.version.store(next_version(), Ordering::Relaxed);
        task(&mut guarded(&self.bytes))
    }
}

fn next_version() -> u64 {
    1 + CHANGES.fetch_add(1, Ordering::Relaxed)
}

/// The present time, from the clock of the browser if there is no other.
fn now() -> SystemTime {
    let since = web_time::SystemTime::now().duration_since(web_time::UNIX_EPOCH).unwrap_or_default();
    SystemTime::UNIX_EPOCH + since
}

fn guarded<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns a path without `.`, `..` and the root; empty for the root.
fn key(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut key, part| {
        match part {
            Component::Normal(name) => key.push(name),
            Component::ParentDir => _ = key.pop(),
            Component::Prefix(_) | Component::RootDir | Component::CurDir => {}
        }
        key
    })
}

fn node(tree: &Tree, key: &Path) -> io::Result<Node> {
    match tree.get(key) {
        Some(node) => Ok(node.clone()),
        None if key == Path::new("") => Ok(Node::Folder),
        None => Err(ErrorKind::NotFound.into()),
    }
}

fn file(tree: &Tree, key: &Path) -> io::Result<Arc<Content>> {
    match node(tree, key)? {
        Node::File(content) => Ok(content),
        Node::Folder => Err(ErrorKind::IsADirectory.into()),
    }
}

/// Returns an error unless a file may have this key.
fn has_folder(tree: &Tree, key: &Path) -> io::Result<()> {
    match node(tree, key.parent().unwrap_or(Path::new(""))) {
        Ok(Node::Folder) => Ok(()),
        Ok(Node::File(_)) => Err(io::Error::new(ErrorKind::NotADirectory, "its parent is not a directory")),
        Err(_) => Err(io::Error::new(ErrorKind::NotFound, "its directory does not exist")),
    }
}

/// Creates the file at `path` with these `bytes`, or replaces it.
///
/// # Errors
/// If its directory does not exist, or if a directory has its name.
pub fn write(path: impl AsRef<Path>, bytes: impl Into<Vec<u8>>) -> io::Result<()> {
    let (key, mut tree) = (key(path.as_ref()), guarded(&TREE));
    has_folder(&tree, &key)?;
    if let Ok(Node::Folder) = node(&tree, &key) {
        return Err(ErrorKind::IsADirectory.into());
    }
    tree.insert(key, Node::File(Arc::new(Content::new(bytes.into()))));
    Ok(())
}

/// Whether there is a file or a folder at `path`.
pub fn exists(path: impl AsRef<Path>) -> bool {
    node(&guarded(&TREE), &key(path.as_ref())).is_ok()
}

/// Does not wait: no other process releases a file.
pub fn wait(_: Duration) {}

/// Returns the kind of anything but a regular file.
pub fn noun(_: &Metadata) -> &'static str {
    "a directory"
}

/// Returns the path from the root.
///
/// # Errors
/// None.
pub fn absolute(path: impl AsRef<Path>) -> io::Result<PathBuf> {
    Ok(Path::new("/").join(key(path.as_ref())))
}

/// Returns the path from the root of a file or a folder that exists.
///
/// # Errors
/// [`ErrorKind::NotFound`].
pub fn canonicalize(path: impl AsRef<Path>) -> io::Result<PathBuf> {
    node(&guarded(&TREE), &key(path.as_ref()))?;
    absolute(path)
}

/// Creates a folder and all those above it.
///
/// # Errors
/// [`ErrorKind::AlreadyExists`] for a file; [`ErrorKind::NotADirectory`] if a file lies above it.
pub fn create_dir_all(path: impl AsRef<Path>) -> io::Result<()> {
    let (key, mut tree) = (key(path.as_ref()), guarded(&TREE));
    let folders: Vec<&Path> = key.ancestors().filter(|folder| *folder != Path::new("")).collect();
    for folder in &folders {
        if let Some(Node::File(_)) = tree.get(*folder) {
            let kind = if *folder == key { ErrorKind::AlreadyExists } else { ErrorKind::NotADirectory };
            return Err(kind.into());
        }
    }
    tree.extend(folders.into_iter().map(|folder| (folder.to_owned(), Node::Folder)));
    Ok(())
}

/// Removes a file.
///
/// # Errors
/// If there is none.
pub fn remove_file(path: impl AsRef<Path>) -> io::Result<()> {
    let (key, mut tree) = (key(path.as_ref()), guarded(&TREE));
    file(&tree, &key)?;
    tree.remove(&key);
    Ok(())
}

/// Removes an empty folder.
///
/// # Errors
/// If there is none, or if it is not empty.
pub fn remove_dir(path: impl AsRef<Path>) -> io::Result<()> {
    if read_dir(path.as_ref())?.next().is_some() {
        return Err(ErrorKind::DirectoryNotEmpty.into());
    }
    guarded(&TREE).remove(&key(path.as_ref()));
    Ok(())
}

/// Removes a folder with all its files.
///
/// # Errors
/// If there is none.
pub fn remove_dir_all(path: impl AsRef<Path>) -> io::Result<()> {
    let (key, mut tree) = (key(path.as_ref()), guarded(&TREE));
    match node(&tree, &key)? {
        Node::File(_) => Err(ErrorKind::NotADirectory.into()),
        Node::Folder => {
            tree.retain(|path, _| !path.starts_with(&key));
            Ok(())
        }
    }
}

/// Returns the files and folders in a folder, sorted by name.
///
/// # Errors
/// If there is no folder at `path`.
pub fn read_dir(path: impl AsRef<Path>) -> io::Result<impl Iterator<Item = io::Result<DirEntry>>> {
    let (path, tree) = (path.as_ref(), guarded(&TREE));
    let key = key(path);
    if let Node::File(_) = node(&tree, &key)? {
        return Err(ErrorKind::NotADirectory.into());
    }
    let inside = tree.iter().filter(|(inner, _)| inner.parent() == Some(key.as_path()));
    let entry = |(inner, node): (&PathBuf, &Node)| DirEntry {
        path: path.join(inner.file_name().unwrap_or_default()),
        node: node.clone(),
    };
    Ok(inside.map(entry).map(Ok).collect::<Vec<_>>().into_iter())
}

/// A file or a folder in a folder.
#[derive(Debug)]
pub struct DirEntry {
    path: PathBuf,
    node: Node,
}

impl DirEntry {
    /// Its path.
    pub fn path(&self) -> PathBuf {
        self.path.clone()
    }

    /// Its name in its folder.
    pub fn file_name(&self) -> OsString {
        self.path.file_name().unwrap_or_default().to_owned()
    }

    /// Its size and kind.
    ///
    /// # Errors
    /// None.
    pub fn metadata(&self) -> io::Result<Metadata> {
        Ok(Metadata::of(&self.node))
    }

    /// Its kind, with its size.
    ///
    /// # Errors
    /// None.
    pub fn file_type(&self) -> io::Result<Metadata> {
        self.metadata()
    }
}

/// Returns the size and the kind of a file or a folder.
///
/// # Errors
/// [`ErrorKind::NotFound`].
pub fn metadata(path: impl AsRef<Path>) -> io::Result<Metadata> {
    node(&guarded(&TREE), &key(path.as_ref())).map(|node| Metadata::of(&node))
}

/// Size, kind and time of the last change of a file or a folder.
#[derive(Debug)]
pub struct Metadata {
    /// Length, time and version; `None` for a folder.
    file: Option<(u64, SystemTime, u64)>,
}

#[expect(clippy::len_without_is_empty, reason = "as in the standard library")]
impl Metadata {
    fn of(node: &Node) -> Self {
        Self {
            file: match node {
                Node::Folder => None,
                Node::File(content) => Some((
                    guarded(&content.bytes).len() as u64,
                    *guarded(&content.modified),
                    content.version.load(Ordering::Relaxed),
                )),
            },
        }
    }

    /// Number of bytes.
    pub fn len(&self) -> u64 {
        self.file.map_or(0, |(length, ..)| length)
    }

    /// A number that grows with each change of a file; 0 for a folder.
    pub fn version(&self) -> u64 {
        self.file.map_or(0, |(.., version)| version)
    }

    /// Whether it is a file.
    pub fn is_file(&self) -> bool {
        self.file.is_some()
    }

    /// Whether it is a folder.
    pub fn is_dir(&self) -> bool {
        self.file.is_none()
    }

    /// Time of the last change of a file.
    ///
    /// # Errors
    /// [`ErrorKind::Unsupported`] for a folder.
    pub fn modified(&self) -> io::Result<SystemTime> {
        self.file.map(|(_, modified, _)| modified).ok_or(ErrorKind::Unsupported.into())
    }
}

/// An open file. Its content outlives its name.
#[derive(Debug)]
pub struct File {
    content: Arc<Content>,
    position: u64,
    appends: bool,
    /// Whether it holds the lock of its content.
    holds: AtomicBool,
}

impl File {
    /// Opens a file for reading.
    ///
    /// # Errors
    /// If there is none.
    pub fn open(path: impl AsRef<Path>) -> io::Result<Self> {
        Self::options().open(path)
    }

    /// Returns the options of a file to be opened.
    pub fn options() -> OpenOptions {
        OpenOptions { create: false, append: false }
    }

    /// Its size.
    ///
    /// # Errors
    /// None.
    pub fn metadata(&self) -> io::Result<Metadata> {
        Ok(Metadata::of(&Node::File(self.content.clone())))
    }

    /// Truncates or extends it.
    ///
    /// # Errors
    /// None.
    pub fn set_len(&self, length: u64) -> io::Result<()> {
        self.content.change(|bytes| bytes.resize(length as usize, 0));
        Ok(())
    }

    /// Does nothing.
    ///
    /// # Errors
    /// None.
    pub fn sync_data(&self) -> io::Result<()> {
        Ok(())
    }

    /// Locks it until it is dropped.
    ///
    /// # Errors
    /// [`TryLockError::WouldBlock`] if another open file holds the lock.
    pub fn try_lock(&self) -> Result<(), TryLockError> {
        match self.content.locked.swap(true, Ordering::Relaxed) {
            true => Err(TryLockError::WouldBlock),
            false => {
                self.holds.store(true, Ordering::Relaxed);
                Ok(())
            }
        }
    }
}

impl Drop for File {
    fn drop(&mut self) {
        if self.holds.load(Ordering::Relaxed) {
            self.content.locked.store(false, Ordering::Relaxed);
        }
    }
}

impl Read for File {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let bytes = guarded(&self.content.bytes);
        let from = (self.position as usize).min(bytes.len());
        let count = buffer.len().min(bytes.len() - from);
        buffer[..count].copy_from_slice(&bytes[from..from + count]);
        self.position += count as u64;
        Ok(count)
    }
}

impl Write for File {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        self.position = self.content.change(|bytes| {
            let from = if self.appends { bytes.len() } else { self.position as usize };
            let to = from + buffer.len();
            if to > bytes.len() {
                bytes.resize(to, 0);
            }
            bytes[from..to].copy_from_slice(buffer);
            to as u64
        });
        Ok(buffer.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for File {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let length = guarded(&self.content.bytes).len() as u64;
        let position = match to {
            SeekFrom::Start(position) => Some(position),
            SeekFrom::End(offset) => length.checked_add_signed(offset),
            SeekFrom::Current(offset) => self.position.checked_add_signed(offset),
        };
        self.position = position.ok_or(ErrorKind::InvalidInput)?;
        Ok(self.position)
    }
}

/// How a file is opened.
#[derive(Debug, Clone)]
pub struct OpenOptions {
    create: bool,
    append: bool,
}

impl OpenOptions {
    /// Does nothing: each open file can be written.
    pub fn write(&mut self, _: bool) -> &mut Self {
        self
    }

    /// Whether to write at the end.
    pub fn append(&mut self, append: bool) -> &mut Self {
        self.append = append;
        self
    }

    /// Whether to create the file if it is missing.
    pub fn create(&mut self, create: bool) -> &mut Self {
        self.create = create;
        self
    }

    /// Does nothing: no file is truncated.
    pub fn truncate(&mut self, truncate: bool) -> &mut Self {
        debug_assert!(!truncate, "no file is truncated");
        self
    }

    /// Opens the file at `path`.
    ///
    /// # Errors
    /// If there is none that can be opened or created.
    pub fn open(&self, path: impl AsRef<Path>) -> io::Result<File> {
        if self.create && !exists(&path) {
            write(&path, Vec::new())?;
        }
        let content = file(&guarded(&TREE), &key(path.as_ref()))?;
        Ok(File { content, position: 0, appends: self.append, holds: AtomicBool::new(false) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::{atomic, regular};

    #[test]
    fn files_are_found_by_name_and_folders_list_them() {
        create_dir_all("list/inner").unwrap();
        write(Path::new("list/b.csv"), vec![1, 2]).unwrap();
        write(Path::new("./list/inner/../a.csv"), vec![3]).unwrap();
        let names = || read_dir("list").unwrap().map(|entry| entry.unwrap().file_name()).collect::<Vec<_>>();
        assert_eq!(names(), ["a.csv", "b.csv", "inner"]);
        assert_eq!(regular::read(Path::new("/list/b.csv"), "a table", 9).unwrap(), [1, 2]);
        assert_eq!(remove_dir("list").unwrap_err().kind(), ErrorKind::DirectoryNotEmpty);
        remove_file("list/b.csv").unwrap();
        assert_eq!(names(), ["a.csv", "inner"]);
        remove_dir_all("list").unwrap();
        assert!(!exists(Path::new("list")) && !exists(Path::new("list/a.csv")));
    }

    #[test]
    fn errors_are_those_of_a_disk() {
        write(Path::new("errors.txt"), Vec::new()).unwrap();
        let kind = |result: io::Result<()>| result.unwrap_err().kind();
        assert_eq!(kind(write(Path::new("none/a"), Vec::new())), ErrorKind::NotFound);
        assert_eq!(kind(write(Path::new("errors.txt/a"), Vec::new())), ErrorKind::NotADirectory);
        assert_eq!(kind(create_dir_all("errors.txt")), ErrorKind::AlreadyExists);
        assert_eq!(kind(create_dir_all("errors.txt/a")), ErrorKind::NotADirectory);
        assert_eq!(kind(File::open("errors.csv").map(|_| ())), ErrorKind::NotFound);
        create_dir_all("errors").unwrap();
        assert_eq!(kind(regular::check(Path::new("errors"), "a file")), ErrorKind::IsADirectory);
        let failed = atomic::write_with(Path::new("errors.txt"), |file| {
            file.write_all(b"half")?;
            Err(ErrorKind::Other.into())
        });
        assert!(failed.is_err() && metadata("errors.txt").unwrap().len() == 0);
    }

    #[test]
    fn a_table_grows_and_is_cut() {
        write(Path::new("rows.csv"), b"a\n".to_vec()).unwrap();
        File::options().append(true).open("rows.csv").unwrap().write_all(b"1\n2\n").unwrap();
        let mut file = File::open("rows.csv").unwrap();
        file.seek(SeekFrom::Start(2)).unwrap();
        let mut rest = String::new();
        file.read_to_string(&mut rest).unwrap();
        assert_eq!(rest, "1\n2\n");
        file.set_len(4).unwrap();
        assert_eq!(metadata("rows.csv").unwrap().len(), 4);
    }

    #[test]
    fn a_lock_ends_with_its_file() {
        let open = || File::options().write(true).create(true).truncate(false).open("lock").unwrap();
        let first = open();
        first.try_lock().unwrap();
        assert!(matches!(open().try_lock(), Err(TryLockError::WouldBlock)));
        drop(first);
        open().try_lock().unwrap();
    }
}
