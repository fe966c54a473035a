//! The table of element kinds of this crate.

use crate::aero::AerodynamicsDescription;
use crate::brake::BrakeDescription;
use crate::drivetrain::{ChainDescription, EngineDescription, EngineRotorDescription, ShaftDriveDescription, VariatorDescription};
use crate::steering::{MultiTrackDescription, SingleTrackDescription, SteeringDamperDescription, SteeringStopDescription};
use crate::suspension::{SwingarmShockDescription, TelescopicForkDescription};
use crate::tire::{ThinDiscLinearDescription, TireDescription};
use mbody::assembly::ElementKind;

/// The URDF in whose terms the examples of this crate are written.
pub const EXAMPLE_TREE: &str = include_str!("example_tree.urdf");

/// The element kinds of this crate; the registry is `Kinds::standard().with(motorcycle::KINDS)`.
pub const KINDS: &[ElementKind] = &[
    ElementKind::of::<TireDescription>(),
    ElementKind::of::<ThinDiscLinearDescription>(),
    ElementKind::of::<TelescopicForkDescription>(),
    ElementKind::of::<SwingarmShockDescription>(),
    ElementKind::of::<ChainDescription>(),
    ElementKind::of::<ShaftDriveDescription>(),
    ElementKind::of::<EngineDescription>(),
    ElementKind::of::<EngineRotorDescription>(),
    ElementKind::of::<VariatorDescription>(),
    ElementKind::of::<BrakeDescription>(),
    ElementKind::of::<AerodynamicsDescription>(),
    ElementKind::of::<SteeringDamperDescription>(),
    ElementKind::of::<SteeringStopDescription>(),
    ElementKind::of::<SingleTrackDescription>(),
    ElementKind::of::<MultiTrackDescription>(),
];

#[cfg(test)]
mod tests {
    use super::*;
    use mbody::assembly::ElementDescription;

    fn reads<T: ElementDescription>() {
        let value: serde_json::Value = serde_yaml::from_str(T::EXAMPLE).unwrap();
        let read: Result<T, _> = serde_json::from_value(value);
        assert!(read.is_ok(), "{}: {:?}", T::KIND, read.err());
    }

    #[test]
    fn every_example_can_be_read() {
        reads::<TireDescription>();
        reads::<ThinDiscLinearDescription>();
        reads::<TelescopicForkDescription>();
        reads::<SwingarmShockDescription>();
        reads::<ChainDescription>();
        reads::<ShaftDriveDescription>();
        reads::<EngineDescription>();
        reads::<EngineRotorDescription>();
        reads::<VariatorDescription>();
        reads::<BrakeDescription>();
        reads::<AerodynamicsDescription>();
        reads::<SteeringDamperDescription>();
        reads::<SteeringStopDescription>();
        reads::<SingleTrackDescription>();
        reads::<MultiTrackDescription>();
    }
}
