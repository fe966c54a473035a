//! Forks, swingarms and their linkages.

mod linkage;
mod swingarm_shock;
mod telescopic_fork;

pub use linkage::{Linkage, LinkageError, LinkagePoints};
pub use swingarm_shock::{ShockGeometry, SwingarmShock, SwingarmShockDescription};
pub use telescopic_fork::TelescopicForkDescription;

/// Name of the limit that the end stops of suspensions declare.
pub const SUSPENSION_STOP: &str = "suspension_stop";
