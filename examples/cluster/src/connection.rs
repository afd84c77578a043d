use std::{path::PathBuf, time::Duration};

use async_nats::{Client, ConnectOptions};
use hitscan_cli::Failure;

use crate::{files, refused, server};

/// How to reach the server.
#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = "Server")]
pub struct Connection {
    /// Its address; several of a cluster are separated by commas [default: nats://127.0.0.1:4222]
    #[arg(long, value_name = "URL")]
    pub server: Option<String>,
    /// User, with --password-file
    #[arg(long, requires = "password_file")]
    user: Option<String>,
    /// File with the user's password
    #[arg(long, value_name = "FILE", requires = "user")]
    password_file: Option<PathBuf>,
    /// File with a token
    #[arg(long, value_name = "FILE", conflicts_with = "user")]
    token_file: Option<PathBuf>,
    /// File with the seed of an nkey
    #[arg(long, value_name = "FILE", conflicts_with_all = ["user", "token_file"])]
    nkey_file: Option<PathBuf>,
    /// File of credentials (JWT and seed), as `nsc` writes it
    #[arg(long, value_name = "FILE", conflicts_with_all = ["user", "token_file", "nkey_file"])]
    creds: Option<PathBuf>,
    /// Insist on TLS; tls:// in the address does so, too
    #[arg(long)]
    tls: bool,
    /// Certificate of the authority that signed the server's [default: those of the system]
    #[arg(long, value_name = "FILE")]
    ca: Option<PathBuf>,
    /// This client's certificate, with --key
    #[arg(long, value_name = "FILE", requires = "key")]
    cert: Option<PathBuf>,
    /// The key of --cert
    #[arg(long, value_name = "FILE", requires = "cert")]
    key: Option<PathBuf>,
}

impl Connection {
    /// The server's address.
    pub fn url(&self) -> String {
        self.server.clone().unwrap_or_else(|| format!("nats://127.0.0.1:{}", server::PORT))
    }

    /// The options as they were given, for other processes.
    pub fn arguments(&self) -> Vec<String> {
        let path = |path: &Option<PathBuf>| path.as_ref().map(|path| path.display().to_string());
        let options = [
            ("--server", self.server.clone()),
            ("--user", self.user.clone()),
            ("--password-file", path(&self.password_file)),
            ("--token-file", path(&self.token_file)),
            ("--nkey-file", path(&self.nkey_file)),
            ("--creds", path(&self.creds)),
            ("--ca", path(&self.ca)),
            ("--cert", path(&self.cert)),
            ("--key", path(&self.key)),
        ];
        let given = options.into_iter().filter_map(|(name, value)| Some([name.to_owned(), value?]));
        given.flatten().chain(self.tls.then(|| "--tls".to_owned())).collect()
    }

    /// Connects, and from then on again whenever the server comes back.
    pub async fn open(&self) -> Result<Client, Failure> {
        /// The longest wait between attempts.
        const PAUSE: Duration = Duration::from_secs(1);
        let secret = |path: &PathBuf| -> Result<String, Failure> {
            Ok(String::from_utf8_lossy(&files::read(path)?).trim().to_owned())
        };
        let mut options = ConnectOptions::new()
            .name("hitscan-cluster")
            .require_tls(self.tls)
            .reconnect_delay_callback(|attempts| PAUSE.min(Duration::from_millis(20 << attempts.min(8))));
        if let Some((user, file)) = self.user.as_ref().zip(self.password_file.as_ref()) {
            options = options.user_and_password(user.clone(), secret(file)?);
        }
        if let Some(file) = &self.token_file {
            options = options.token(secret(file)?);
        }
        if let Some(file) = &self.nkey_file {
            options = options.nkey(secret(file)?);
        }
        if let Some(file) = &self.creds {
            let read = options.credentials_file(file).await;
            options = read.map_err(|error| Failure::new(format!("{}: {error}", file.display()), "check the path"))?;
        }
        if let Some(file) = &self.ca {
            options = options.add_root_certificates(file.clone());
        }
        if let Some((cert, key)) = self.cert.as_ref().zip(self.key.as_ref()) {
            options = options.add_client_certificate(cert.clone(), key.clone());
        }
        let url = self.url();
        let addresses: Vec<&str> = url.split(',').collect();
        let connected = options.connect(addresses).await;
        connected.map_err(|error| refused(&format!("no connection to {url}"), error))
    }
}
