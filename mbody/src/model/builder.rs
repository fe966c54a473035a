//! Puts a model together, body by body.

use super::{Body, BodyIndex, Follower, Frame, Layout, Model};
use crate::joint::{Fixed, Joint};
use crate::spatial::{MassProperties, Pose, Turn, Vec3};
use thiserror::Error;

/// Why a model could not be built.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum BuildError {
    /// Two bodies, joints or frames have one name.
    #[error("the name `{name}` is used twice")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// A joint that others refer to does not exist.
    #[error("joint `{joint}` does not exist")]
    UnknownJoint {
        /// The joint.
        joint: String,
    },
    /// Only joints with one coordinate can follow or lead.
    #[error("joint `{joint}` has {coordinates} coordinates; only a joint with one can follow another or lead it")]
    NotOneCoordinate {
        /// The joint.
        joint: String,
        /// How many it has.
        coordinates: usize,
    },
    /// A joint follows itself, directly or through others.
    #[error("joint `{joint}` follows itself")]
    FollowsItself {
        /// The joint.
        joint: String,
    },
}

/// Builds a [`Model`]: parents first.
#[derive(Debug)]
pub struct ModelBuilder {
    bodies: Vec<Body>,
    frames: Vec<Frame>,
    gravity: Vec3<f64>,
    follow: Vec<(BodyIndex, BodyIndex, f64, f64)>,
    nq: usize,
    nv: usize,
}

impl Default for ModelBuilder {
    fn default() -> Self {
        Self::new()
    }
}

impl ModelBuilder {
    /// Starts with the world and standard gravity 9.81 m/s² along −z.
    pub fn new() -> Self {
        let world = Body {
            name: "world".into(),
            parent: BodyIndex::WORLD,
            joint_name: String::new(),
            joint: Joint::new(Fixed),
            X_PF: Pose::identity(),
            turn: Turn::Still,
            mass: MassProperties::NONE,
            inertia: MassProperties::NONE.spatial(),
            q: 0..0,
            v: 0..0,
        };
        let frame = Frame { name: "world".into(), body: BodyIndex::WORLD, X_BF: Pose::identity() };
        Self { bodies: vec![world], frames: vec![frame], gravity: Vec3::new(0.0, 0.0, -9.81), follow: Vec::new(), nq: 0, nv: 0 }
    }

    /// Sets the acceleration of free fall, m/s².
    pub fn gravity(&mut self, gravity: Vec3<f64>) -> &mut Self {
        self.gravity = gravity;
        self
    }

    fn new_name(&self, name: &str) -> Result<(), BuildError> {
        match self.frames.iter().any(|f| f.name == name) {
            true => Err(BuildError::DuplicateName { name: name.into() }),
            false => Ok(()),
        }
    }

    /// Adds a moving body: `joint` leads from the frame `X_PF` in the parent to the body frame.
    pub fn body(
        &mut self,
        name: &str,
        parent: BodyIndex,
        joint_name: &str,
        joint: Joint,
        X_PF: Pose<f64>,
        mass: MassProperties,
    ) -> Result<BodyIndex, BuildError> {
        self.new_name(name)?;
        if self.bodies.iter().skip(1).any(|b| b.joint_name == joint_name) {
            return Err(BuildError::DuplicateName { name: joint_name.into() });
        }
        let index = BodyIndex(self.bodies.len());
        let (q, v) = (self.nq..self.nq + joint.nq(), self.nv..self.nv + joint.nv());
        (self.nq, self.nv) = (q.end, v.end);
        self.frames.push(Frame { name: name.into(), body: index, X_BF: Pose::identity() });
        let (inertia, turn) = (mass.spatial(), Turn::of(&X_PF.R).then(joint.turn()));
        let joint_name = joint_name.into();
        self.bodies.push(Body { name: name.into(), parent, joint_name, joint, X_PF, turn, mass, inertia, q, v });
        Ok(index)
    }

    /// Welds mass to a body at `X_BF` and keeps the place as a named frame.
    pub fn weld(&mut self, name: &str, body: BodyIndex, X_BF: Pose<f64>, mass: MassProperties) -> Result<(), BuildError> {
        self.new_name(name)?;
        self.frames.push(Frame { name: name.into(), body, X_BF });
        let b = &mut self.bodies[body.0];
        b.mass = b.mass.welded_with(&mass.in_parent(&X_BF));
        b.inertia = b.mass.spatial();
        Ok(())
    }

    /// Where a frame of this name is: its body and its pose there.
    pub fn find(&self, frame: &str) -> Option<(BodyIndex, Pose<f64>)> {
        self.frames.iter().find(|f| f.name == frame).map(|f| (f.body, f.X_BF))
    }

    /// Makes the coordinate of one joint follow another's: `q = ratio·q_leader + offset`.
    pub fn follow(&mut self, joint: &str, leader: &str, ratio: f64, offset: f64) -> Result<(), BuildError> {
        let find = |name: &str| {
            let found = (1..self.bodies.len()).find(|&i| self.bodies[i].joint_name == name).map(BodyIndex);
            let body = found.ok_or(BuildError::UnknownJoint { joint: name.into() })?;
            let coordinates = self.bodies[body.0].q.len();
            match coordinates {
                1 => Ok(body),
                _ => Err(BuildError::NotOneCoordinate { joint: name.into(), coordinates }),
            }
        };
        let pair = (find(joint)?, find(leader)?);
        if pair.0 == pair.1 {
            return Err(BuildError::FollowsItself { joint: joint.into() });
        }
        self.follow.push((pair.0, pair.1, ratio, offset));
        Ok(())
    }

    /// The finished model.
    pub fn finish(self) -> Result<Model, BuildError> {
        let mut followers = Vec::new();
        let mut ready: Vec<bool> = (0..self.bodies.len()).map(|i| !self.follow.iter().any(|f| f.0.0 == i)).collect();
        let mut waiting = self.follow.clone();
        // each follower after its leader, so that one pass expands chains
        while !waiting.is_empty() {
            let Some(at) = waiting.iter().position(|f| ready[f.1.0]) else {
                return Err(BuildError::FollowsItself { joint: self.bodies[waiting[0].0.0].joint_name.clone() });
            };
            let (body, leader, ratio, offset) = waiting.remove(at);
            ready[body.0] = true;
            let (b, l) = (&self.bodies[body.0], &self.bodies[leader.0]);
            followers.push(Follower { q: b.q.start, v: b.v.start, leader_q: l.q.start, leader_v: l.v.start, ratio, offset });
        }
        let independent_q = (0..self.nq).filter(|&q| followers.iter().all(|f| f.q != q)).collect();
        let independent_v = (0..self.nv).filter(|&v| followers.iter().all(|f| f.v != v)).collect();
        let layout = Layout { tree_nq: self.nq, tree_nv: self.nv, independent_q, independent_v, followers };
        Ok(Model { bodies: self.bodies, frames: self.frames, layout, gravity: self.gravity })
    }
}
