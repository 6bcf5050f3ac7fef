//! Front ends of a run: --live, a page that displays the run and steers it if the command drives, --mqtt and --foxglove.

use crate::console;
use clap::Args;
use std::path::PathBuf;
use trundle::app::operator::{FrontEnd, MapFolder, Operator, OperatorLink, operator_link, refuse_for_replay};
use trundle::app::{AppError, Progress, RunSetup};
#[cfg(feature = "foxglove")]
use trundle::foxglove;
use trundle::live::{LiveAddress, LiveOptions, LivePage, RunFacts, Tokens};
use trundle::runtime::RobotConfig;

/// The page of a command, for a browser.
#[derive(Debug, Clone, Args)]
pub struct ViewArgs {
    /// Display the command's work in a browser, and steer a run there: prints the link; a run continues after its mission until Ctrl-C. ADDR
    /// is IP:PORT [default: 127.0.0.1:8642, or a free port if it is in use]
    #[arg(long, value_name = "ADDR", num_args = 0..=1, default_missing_value = LiveAddress::DEFAULT)]
    pub live: Option<LiveAddress>,
    /// Store the tokens of the links in FILE, which keeps links valid after restarts.
    #[arg(long, value_name = "FILE", requires = "live", hide_short_help = true)]
    pub live_tokens: Option<PathBuf>,
    /// Encrypt the page with this certificate: a PEM file, with the chain.
    #[cfg(feature = "tls")]
    #[arg(long, value_name = "FILE", requires = "live", requires = "live_key", hide_short_help = true)]
    pub live_certificate: Option<PathBuf>,
    /// Key of the certificate: a PEM file.
    #[cfg(feature = "tls")]
    #[arg(long, value_name = "FILE", requires = "live_certificate", hide_short_help = true)]
    pub live_key: Option<PathBuf>,
}

/// The live page of a run.
#[derive(Debug, Args)]
pub struct LiveArgs {
    /// The page.
    #[command(flatten)]
    pub view: ViewArgs,
    /// Zones and named places of the map: a GeoJSON file, which stores the changes of the live page. A missing file is created by the first
    /// change.
    #[arg(long, value_name = "FILE")]
    pub zones: Option<PathBuf>,
    /// Maps that the live page may load while the robot runs: each NAME.yaml of DIR.
    #[arg(long, value_name = "DIR", requires = "live", value_parser = MapFolder::checked)]
    pub maps: Option<PathBuf>,
    /// Home and fleet.
    #[cfg(feature = "mqtt")]
    #[command(flatten)]
    pub mqtt: crate::mqtt::MqttArgs,
    /// Show the run in Foxglove or Lichtblick, which cannot command the robot. ADDR is IP:PORT [default: 127.0.0.1:8765]
    #[cfg(feature = "foxglove")]
    #[arg(long, value_name = "ADDR", num_args = 0..=1, default_missing_value = foxglove::DEFAULT_ADDRESS, value_parser = foxglove::read_foxglove_address)]
    pub foxglove: Option<std::net::SocketAddr>,
    /// A further page that may connect, as http://localhost:8080 of a Lichtblick of your own.
    #[cfg(feature = "foxglove")]
    #[arg(long, value_name = "ORIGIN", requires = "foxglove", hide_short_help = true)]
    pub foxglove_origin: Vec<foxglove::PageOrigin>,
}

/// Front ends of a run; a drop ends them.
#[derive(Default)]
pub struct FrontEnds {
    _page: Option<LivePage>,
    #[cfg(feature = "mqtt")]
    _fleet: Option<trundle::fleet::FleetLink>,
    #[cfg(feature = "foxglove")]
    _foxglove: Option<foxglove::FoxgloveServer>,
}

impl LiveArgs {
    /// Whether a person may give commands to the run.
    pub fn is_operated(&self) -> bool {
        #[cfg(feature = "mqtt")]
        if self.mqtt.mqtt.is_some() {
            return true;
        }
        self.view.live.is_some()
    }

    /// The run with the requested zones.
    pub fn with_zones(&self, setup: RunSetup) -> Result<RunSetup, AppError> {
        self.zones.as_deref().map_or(Ok(setup.clone()), |file| setup.with_annotations_of(file))
    }

    /// The requested front ends of a run, and the run's companions. `link` is the link of another front end. A run without an
    /// operator accepts no commands.
    pub fn front_ends(
        &self,
        setup: &RunSetup,
        progress: Progress,
        link: Option<OperatorLink>,
        is_steered: bool,
    ) -> Result<(FrontEnds, FrontEnd), AppError> {
        if !is_steered {
            refuse_for_replay(self.zones.as_deref(), self.maps.as_deref())?;
        }
        #[cfg(feature = "foxglove")]
        let is_shown = self.foxglove.is_some() || self.is_operated();
        #[cfg(not(feature = "foxglove"))]
        let is_shown = self.is_operated();
        if !is_shown {
            return Ok((FrontEnds::default(), FrontEnd { progress, operator: link }));
        }
        let link = link.unwrap_or_else(|| operator_link().1);
        let front_ends = FrontEnds {
            _page: self.page(setup, &link, is_steered)?,
            #[cfg(feature = "mqtt")]
            _fleet: self.mqtt.join(setup, &link, is_steered)?,
            #[cfg(feature = "foxglove")]
            _foxglove: foxglove::FoxgloveServer::for_run(setup, &link, self.foxglove, &self.foxglove_origin)?
                .inspect(|server| console::print(&server.announcement())),
        };
        Ok((front_ends, FrontEnd { progress, operator: Some(link) }))
    }

    fn page(
        &self,
        setup: &RunSetup,
        link: &OperatorLink,
        is_steered: bool,
    ) -> Result<Option<LivePage>, AppError> {
        let maps = self.maps.clone().map(|folder| MapFolder::open(folder, setup.robot.clone()));
        let maps = maps.transpose().map_err(|problem| AppError::Input(format!("--maps {problem}")))?;
        self.view.serve(link.operator(), || Ok(RunFacts::of(setup)?), is_steered, maps)
    }
}

impl ViewArgs {
    /// The page of `operator` if requested, with its links printed. A drop ends the page.
    fn serve(
        &self,
        operator: Operator,
        facts: impl FnOnce() -> Result<RunFacts, AppError>,
        is_steered: bool,
        maps: Option<MapFolder>,
    ) -> Result<Option<LivePage>, AppError> {
        let Some(address) = self.live else { return Ok(None) };
        let tokens = self.live_tokens.as_deref().map_or_else(Tokens::random, Tokens::of_file)?;
        let options = LiveOptions::new(address, tokens, is_steered, maps);
        #[cfg(feature = "tls")]
        let options = options.encrypted(self.live_certificate.as_deref().zip(self.live_key.as_deref()))?;
        let page = LivePage::start(options, operator, facts()?)?;
        console::print(&page.announcement());
        Ok(Some(page))
    }

    /// The page with `facts` if requested, and its feed. A drop ends the page.
    pub fn start(
        &self,
        facts: impl FnOnce() -> Result<RunFacts, AppError>,
        is_steered: bool,
    ) -> Result<Option<(LivePage, OperatorLink)>, AppError> {
        let (operator, link) = operator_link();
        Ok(self.serve(operator, facts, is_steered, None)?.map(|page| (page, link)))
    }

    /// The page of an experiment with this robot.
    pub fn of_experiment(
        &self,
        name: &str,
        robot: &RobotConfig,
    ) -> Result<Option<(LivePage, OperatorLink)>, AppError> {
        self.start(|| Ok(RunFacts::of_experiment(name, robot)?), false)
    }
}
