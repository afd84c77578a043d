//! A server on a port and in a folder of its own, and the program run against it.

use std::{
    fs,
    net::{TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, Output, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

use hitscan_cli::{Casting, Settings, Source, write_png};

/// How long anything may take.
const PATIENCE: Duration = Duration::from_secs(60);

/// The asset that is drawn: rows of tetrahedra.
const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const WORLD: &str =
    "[part.a]\nmesh = \"mesh.obj\"\n[[place]]\npart = \"a\"\ngrid = [4, 4, 4]\nstep = [1.5, 1.2, 1.5]\n";

/// A process that ends with its handle.
pub struct Process(Child);

impl std::ops::Deref for Process {
    type Target = Child;
    fn deref(&self) -> &Child {
        &self.0
    }
}

impl std::ops::DerefMut for Process {
    fn deref_mut(&mut self) -> &mut Child {
        &mut self.0
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

pub struct Cluster {
    folder: tempfile::TempDir,
    port: u16,
    server: Option<Process>,
}

impl Cluster {
    /// A server, and `scene.hits`.
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("mesh.obj"), MESH).unwrap();
        fs::write(folder.path().join("scene.toml"), WORLD).unwrap();
        let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        let mut cluster = Self { folder, port, server: None };
        hitscan_cli::bake_world(&cluster.path("scene.toml"), &cluster.path("scene.hits")).unwrap();
        cluster.start_server();
        cluster
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn start_server(&mut self) {
        self.start_server_with(&[]);
    }

    /// Starts `nats-server` itself, with these arguments, too.
    pub fn start_server_with(&mut self, more: &[&str]) {
        let program = ["/usr/sbin/nats-server", "/usr/local/bin/nats-server", "/usr/bin/nats-server"];
        let program = program.iter().find(|path| Path::new(path).exists()).expect("install nats-server");
        let mut command = Command::new(program);
        command.args(["-a", "127.0.0.1", "-p", &self.port.to_string(), "-js", "-sd"]).arg(self.path("store"));
        command.args(more).stdout(Stdio::null()).stderr(Stdio::null());
        self.server = Some(Process(command.spawn().unwrap()));
        self.wait_until(|| TcpStream::connect(("127.0.0.1", self.port)).is_ok());
        sleep(Duration::from_millis(200));
    }

    /// Kills it with -9.
    pub fn stop_server(&mut self) {
        self.server = None;
    }

    /// Starts the program against the server, its arguments separated by blanks.
    pub fn start(&self, arguments: &str) -> Child {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hitscan-cluster"));
        command.current_dir(self.folder.path()).args(arguments.split_whitespace());
        if !arguments.contains("--server") && !arguments.starts_with("serve") {
            command.args(["--server", &format!("nats://127.0.0.1:{}", self.port)]);
        }
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    }

    fn output(&self, arguments: &str) -> Output {
        self.start(arguments).wait_with_output().unwrap()
    }

    /// Runs it, which must succeed; what it printed.
    pub fn run(&self, arguments: &str) -> String {
        let output = self.output(arguments);
        assert!(output.status.success(), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs it, which must refuse in one line with code 2; that line.
    pub fn refuse(&self, arguments: &str) -> String {
        let output = self.output(arguments);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments}: {errors}");
        assert!(errors.starts_with("hitscan-cluster: ") && errors.lines().count() == 1, "{arguments}: {errors:?}");
        errors
    }

    /// A worker of one thread, whose tiles others get after two seconds.
    pub fn worker(&self, options: &str) -> Process {
        let cache = self.path("cache");
        Process(self.start(&format!("worker --threads 1 --ack-wait 2 --cache {} {options}", cache.display())))
    }

    /// Draws `shared.png` with the workers there are.
    pub fn submit(&self, settings: &str) {
        self.run(&format!("submit scene.hits -o shared.png {settings}"));
    }

    /// The same, with a worker that is there only for that.
    pub fn submit_with_worker(&self, settings: &str) {
        let _worker = self.worker("");
        self.submit(settings);
    }

    /// Enters the job without waiting for it; its name.
    pub fn detach(&self, settings: &str) -> String {
        let text = self.run(&format!("submit scene.hits {settings} --detach"));
        text.strip_prefix("job ").and_then(|rest| rest.split(':').next()).unwrap().to_owned()
    }

    /// Waits until so many tiles of a job are done; how many are.
    pub fn wait_for(&self, id: &str, tiles: u32) -> u32 {
        let mut done = 0;
        self.wait_until(|| {
            let status = self.run("status");
            let line = status.lines().find(|line| line.contains(id)).unwrap_or_else(|| panic!("{status}"));
            let words: Vec<&str> = line.split(' ').collect();
            let of = words.iter().rposition(|word| *word == "of").unwrap();
            done = words[of - 1].parse().unwrap();
            done >= tiles
        });
        done
    }

    /// How many tiles each worker says it has done.
    pub fn done_by_workers(&self) -> Vec<u32> {
        let status = self.run("status");
        let tiles = status.lines().filter_map(|line| line.split(" threads, ").nth(1)?.split(' ').next());
        tiles.filter_map(|tiles| tiles.parse().ok()).collect()
    }

    pub fn wait_until(&self, mut condition: impl FnMut() -> bool) {
        let begun = Instant::now();
        while !condition() {
            assert!(begun.elapsed() < PATIENCE, "it never happened");
            sleep(Duration::from_millis(50));
        }
    }

    /// `shared.png` must be what one machine draws.
    pub fn compare(&self, settings: &str) {
        let words: Vec<String> = settings.split_whitespace().map(str::to_owned).collect();
        let settings = Settings::parse(&words).unwrap();
        let (width, height) = settings.size();
        let asset = self.path("scene.hits");
        let source = Source::load(&asset).unwrap();
        let pixels = settings.shoot(&source, &asset, |shot| shot.rows(0..height)).unwrap();
        write_png(&self.path("alone.png"), width, height, &pixels).unwrap();
        let [shared, alone] = ["shared.png", "alone.png"].map(|name| fs::read(self.path(name)).unwrap());
        assert!(shared == alone, "another picture");
        assert!(pixels.iter().any(|pixel| *pixel != pixels[0]), "an empty picture");
    }

    /// What one machine answers to rays.
    pub fn cast_alone(&self, rays: &[u8], query: &str) -> Vec<u8> {
        let asset = self.path("scene.hits");
        let source = Source::load(&asset).unwrap();
        let casting = Casting::parse(&["--query".to_owned(), query.to_owned()]).unwrap();
        casting.open(&source, &asset, |cast| Ok(cast(rays))).unwrap()
    }

    /// Puts other bytes under the asset's name on the server.
    pub fn corrupt_asset(&self) {
        let asset = self.path("scene.hits");
        let mut bytes = fs::read(&asset).unwrap();
        let name = {
            use sha2::{Digest, Sha256};
            Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect::<String>()
        };
        bytes[500] ^= 1;
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let client = async_nats::connect(format!("127.0.0.1:{}", self.port)).await.unwrap();
            let store = async_nats::jetstream::new(client).get_object_store("hitscan-assets").await.unwrap();
            store.put(name.as_str(), &mut &bytes[..]).await.unwrap();
        });
    }
}

/// Sends a process a signal by name.
pub fn signal(process: &Child, name: &str) {
    let sent = Command::new("kill").arg(format!("-{name}")).arg(process.id().to_string()).status().unwrap();
    assert!(sent.success());
}
