//! Permissions to drive and to view: two random tokens.

use crate::LiveError;
use std::fmt::Write as _;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;
use subtle::{Choice, ConstantTimeEq};
use trundle_app::BoundedFile;

/// Permissions of a viewer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// View the run, and drive the robot.
    Drive,
    /// View the run.
    View,
}

/// Length of a token \[bytes\]: 128 bits cannot be guessed. Source: ours.
const TOKEN_BYTES: usize = 16;
/// Largest token file that is read \[bytes\]. Source: ours.
const MAX_TOKEN_FILE_BYTES: u64 = 1024;

/// The token for driving and the token for viewing, as hexadecimal text.
#[derive(Clone)]
pub struct Tokens {
    drive: String,
    view: String,
}

impl Tokens {
    /// New random tokens.
    ///
    /// # Errors
    /// When the system gives no random bytes.
    pub fn random() -> Result<Self, LiveError> {
        Ok(Self { drive: random_token()?, view: random_token()? })
    }

    /// The tokens of a file; a missing file is created with new ones. Links are therefore valid after restarts.
    ///
    /// # Errors
    /// When the file cannot be read or written, or holds no tokens.
    pub fn of_file(file: &Path) -> Result<Self, LiveError> {
        let broken = |problem: String| LiveError::TokenFile { file: file.to_owned(), problem };
        match (BoundedFile { path: file, folder: None, max_bytes: MAX_TOKEN_FILE_BYTES }).read() {
            Ok(bytes) => Self::parse(&String::from_utf8_lossy(&bytes)).map_err(broken),
            Err(error) if error.is_missing() => {
                let tokens = Self::random()?;
                let text = format!("drive {}\nview {}\n", tokens.drive, tokens.view);
                create_private(file)
                    .and_then(|mut file| file.write_all(text.as_bytes()))
                    .map_err(|error| broken(error.to_string()))?;
                Ok(tokens)
            }
            Err(error) => Err(broken(format!("it {error}; expected a file of two lines"))),
        }
    }

    fn parse(text: &str) -> Result<Self, String> {
        let of = |name: &str| {
            let mut lines = text.lines().filter_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
            let token = lines.next().map(str::trim).filter(|token| is_token(token));
            token.map(str::to_owned).ok_or_else(|| {
                format!("expected a line '{name} TOKEN' with 32 hexadecimal digits; delete the file for new tokens")
            })
        };
        let (drive, view) = (of("drive")?, of("view")?);
        if drive == view {
            return Err("the two tokens are equal; delete the file for new tokens".to_owned());
        }
        Ok(Self { drive, view })
    }

    /// The token of an access.
    #[must_use]
    pub fn of(&self, access: Access) -> &str {
        match access {
            Access::Drive => &self.drive,
            Access::View => &self.view,
        }
    }

    /// Permission of a token; `None` for a wrong one. The computing time is independent of the position of a difference.
    #[must_use]
    pub fn access(&self, token: &str) -> Option<Access> {
        let is = |known: &str| -> Choice { known.as_bytes().ct_eq(token.as_bytes()) };
        let (drives, views) = (is(&self.drive), is(&self.view));
        if bool::from(drives) {
            Some(Access::Drive)
        } else if bool::from(views) {
            Some(Access::View)
        } else {
            None
        }
    }
}

/// A debug text must not show a token.
impl std::fmt::Debug for Tokens {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Tokens")
    }
}

fn is_token(text: &str) -> bool {
    text.len() == 2 * TOKEN_BYTES && text.bytes().all(|byte| byte.is_ascii_hexdigit())
}

fn random_token() -> Result<String, LiveError> {
    let mut bytes = [0; TOKEN_BYTES];
    getrandom::fill(&mut bytes).map_err(|error| LiveError::System(format!("no random bytes: {error}")))?;
    let mut text = String::with_capacity(2 * TOKEN_BYTES);
    bytes.iter().for_each(|byte| _ = write!(text, "{byte:02x}"));
    Ok(text)
}

/// A new file that only its owner can read.
fn create_private(file: &Path) -> std::io::Result<std::fs::File> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_gives_its_access_and_no_other() {
        let tokens = Tokens::random().unwrap();
        assert_eq!(tokens.access(tokens.of(Access::Drive)), Some(Access::Drive));
        assert_eq!(tokens.access(tokens.of(Access::View)), Some(Access::View));
        for wrong in ["", "0", &"0".repeat(32), &tokens.of(Access::Drive)[1..]] {
            assert_eq!(tokens.access(wrong), None);
        }
        assert_ne!(tokens.of(Access::Drive), Tokens::random().unwrap().of(Access::Drive));
        assert_eq!(format!("{tokens:?}"), "Tokens");
    }

    #[test]
    fn a_token_file_keeps_the_links_and_is_private() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("tokens");
        let first = Tokens::of_file(&file).unwrap();
        assert_eq!(Tokens::of_file(&file).unwrap().of(Access::Drive), first.of(Access::Drive));
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            assert_eq!(std::fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o600);
        }
        for broken in ["", "drive 12\nview 34\n", "drive zz\n"] {
            std::fs::write(&file, broken).unwrap();
            assert!(Tokens::of_file(&file).unwrap_err().to_string().contains("expected a line"), "{broken}");
        }
        let same = "ab".repeat(16);
        std::fs::write(&file, format!("drive {same}\nview {same}\n")).unwrap();
        assert!(Tokens::of_file(&file).is_err());
    }
}
