use std::{
    env,
    net::{SocketAddr, TcpStream},
    path::{Path, PathBuf},
    process::Stdio,
    time::Duration,
};

use hitscan_cli::Failure;
use tokio::process::{Child, Command};

use crate::files;

/// Where the server listens if nothing else is said, as everywhere.
pub const PORT: u16 = 4222;

/// Run a server on this machine until interrupted
///
/// It is `nats-server`, reached from this machine only. For other machines give it an address, and a configuration that
/// says who may come in.
#[derive(Clone, Debug, clap::Args)]
pub struct Serve {
    /// Address to listen at; anything but a loopback address needs --config with authentication
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1")]
    pub listen: std::net::IpAddr,
    /// Port to listen at
    #[arg(long, default_value_t = PORT)]
    pub port: u16,
    /// Folder of its queue and assets [default: in the user's cache]
    #[arg(long, value_name = "FOLDER")]
    pub store: Option<PathBuf>,
    /// Configuration of nats-server: users, TLS, clusters
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// The program [default: nats-server on the path, /usr/sbin or /usr/local/bin]
    #[arg(long, value_name = "FILE")]
    pub nats_server: Option<PathBuf>,
}

impl Serve {
    /// One on loopback, for this machine alone.
    pub fn embedded(store: Option<PathBuf>) -> Self {
        Self { listen: [127, 0, 0, 1].into(), port: PORT, store, config: None, nats_server: None }
    }

    /// Whether somebody listens there already.
    pub fn is_up(&self) -> bool {
        TcpStream::connect_timeout(&SocketAddr::new(self.listen, self.port), Duration::from_millis(300)).is_ok()
    }

    /// Starts it; it ends with the handle.
    pub async fn start(&self) -> Result<Child, Failure> {
        if !self.listen.is_loopback() && self.config.is_none() {
            let what = format!("--listen {}: everybody on that network could come in", self.listen);
            return Err(Failure::new(what, "give --config with users or tokens, and TLS"));
        }
        let program = self.program()?;
        let store = self.store.clone().unwrap_or_else(|| files::home().join("store"));
        files::make(&store)?;
        let mut command = Command::new(&program);
        command.args(["-a", &self.listen.to_string(), "-p", &self.port.to_string(), "-js", "-sd"]).arg(&store);
        if let Some(config) = &self.config {
            command.arg("-c").arg(config);
        }
        let log = store.join("server.log");
        command.arg("-l").arg(&log).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let refuse =
            |why: String| Failure::new(format!("{}: {why}", program.display()), "see its log, or name another");
        let mut child = command.kill_on_drop(true).spawn().map_err(|error| refuse(error.to_string()))?;
        for _ in 0..100 {
            if let Ok(Some(status)) = child.try_wait() {
                return Err(refuse(format!("ended with {status}, log {}", log.display())));
            }
            if self.is_up() {
                return Ok(child);
            }
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
        Err(refuse(format!("does not listen at port {}, log {}", self.port, log.display())))
    }

    fn program(&self) -> Result<PathBuf, Failure> {
        let path = env::var_os("PATH").unwrap_or_default();
        let folders =
            env::split_paths(&path).chain(["/usr/sbin", "/usr/local/bin", "/usr/local/sbin"].map(PathBuf::from));
        let named = self.nats_server.clone();
        let mut candidates = folders.map(|folder| folder.join("nats-server"));
        named.or_else(|| candidates.find(|file| is_file(file))).filter(|file| is_file(file)).ok_or_else(|| {
            let mend = "install it (Debian: apt-get install nats-server), or name a running one with --server";
            Failure::new("nats-server: not found", mend)
        })
    }

    pub async fn run(&self) -> Result<(), Failure> {
        let mut child = self.start().await?;
        println!("nats-server at nats://{}:{}", self.listen, self.port);
        tokio::select! {
            ended = child.wait() => {
                let status = ended.map_or_else(|error| error.to_string(), |status| status.to_string());
                Err(Failure::new(format!("nats-server ended: {status}"), "see its log"))
            }
            _ = tokio::signal::ctrl_c() => Ok(()),
        }
    }
}

fn is_file(path: &Path) -> bool {
    path.metadata().is_ok_and(|data| data.is_file())
}
