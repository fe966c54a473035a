//! The tree of a model alone, in a motion given by signal names: positions, velocities and energies without constraints and elements.
//!
//! Holds reference motions against the geometry and inertia of our models: a closed loop of the source must be closed here, an energy that
//! it keeps must be kept here.

use crate::reference::repository_text;
use mbody::algorithm::{energy, kinematics};
use mbody::assembly::{BaseDescription, assemble_urdf};
use mbody::dynamics::System;
use mbody::spatial::{Rotation, Vec3};
use mbody::stage::Workspace;
use std::sync::Arc;

/// Named values: `("crank.angle", 0.1)`.
pub type Named = (&'static str, f64);

/// A chain of equal links, each 0.1 m long and 1 kg, that hangs from the world by revolute joints about y and x in turn.
///
/// # Panics
/// It does not assemble.
pub fn chain(links: usize) -> Arc<System> {
    let mut urdf = String::from("<robot name=\"chain\"><link name=\"ground\"/>");
    for k in 0..links {
        let (parent, drop) = if k == 0 { ("ground".to_owned(), 0.0) } else { (format!("link_{}", k - 1), -0.1) };
        let axis = if k % 2 == 0 { "0 1 0" } else { "1 0 0" };
        urdf += &format!(
            "<link name=\"link_{k}\"><inertial><origin xyz=\"0 0 -0.05\"/><mass value=\"1\"/>\
             <inertia ixx=\"0.001\" iyy=\"0.001\" izz=\"0.0002\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\
             <joint name=\"joint_{k}\" type=\"continuous\"><parent link=\"{parent}\"/><child link=\"link_{k}\"/>\
             <origin xyz=\"0 0 {drop}\"/><axis xyz=\"{axis}\"/></joint>"
        );
    }
    urdf += "</robot>";
    let (assembled, findings) = assemble_urdf("chain.urdf", &urdf, BaseDescription::Fixed, 9.81, &[]);
    assembled.unwrap_or_else(|| panic!("{findings}")).system
}

/// A tree in motion.
#[derive(Debug)]
pub struct Tree {
    system: Arc<System>,
    w: Workspace<f64>,
}

impl Tree {
    /// The tree of a URDF of the repository, by its path from the top, in its reference pose at rest.
    ///
    /// # Panics
    /// It does not assemble.
    pub fn of(path: &str, base: BaseDescription, gravity: f64) -> Self {
        let file = path.rsplit('/').next().unwrap_or(path);
        let (assembled, findings) = assemble_urdf(file, &repository_text(path), base, gravity, &[]);
        let system = assembled.unwrap_or_else(|| panic!("{findings}")).system;
        let w = Workspace::new(system.model());
        let mut tree = Self { system, w };
        tree.follow();
        tree
    }

    /// Puts coordinates and velocities, each by its name; the others stay.
    ///
    /// # Panics
    /// An unknown name.
    pub fn put(&mut self, values: &[Named]) {
        let nq = self.w.position.q.len();
        for (name, value) in values {
            // without elements nothing tells a wheel from another revolute joint
            let plain = name.strip_suffix(".spin_rate").map_or_else(|| (*name).to_owned(), |joint| format!("{joint}.rate"));
            let unknowns = self.system.unknowns();
            let at = unknowns.iter().position(|u| u.signal.name == plain).unwrap_or_else(|| panic!("no unknown `{name}`"));
            match at.checked_sub(nq) {
                None => self.w.position.q[at] = *value,
                Some(k) => self.w.velocity.v[k] = *value,
            }
        }
        self.follow();
    }

    fn follow(&mut self) {
        let (model, w) = (self.system.model(), &mut self.w);
        kinematics::position(model, &mut w.position);
        kinematics::world(model, &w.position, &mut w.world);
        kinematics::velocity(model, &w.position, &mut w.velocity);
    }

    /// Position of a point of a link in the world, m.
    ///
    /// # Panics
    /// There is no such link.
    pub fn position(&self, link: &str, at: [f64; 3]) -> Vec3<f64> {
        let frame = self.system.model().frame(link).unwrap_or_else(|| panic!("no link `{link}`"));
        self.w.world.X_WB[frame.body.get()].point(frame.X_BF.point(at.into()))
    }

    /// Velocity of a point of a link in the world, m/s.
    ///
    /// # Panics
    /// There is no such link.
    pub fn velocity(&self, link: &str, at: [f64; 3]) -> Vec3<f64> {
        let frame = self.system.model().frame(link).unwrap_or_else(|| panic!("no link `{link}`"));
        let body = frame.body.get();
        self.w.world.X_WB[body].R * self.w.velocity.V_WB[body].at_point(frame.X_BF.point(at.into()))
    }

    /// Orientation of a link in the world.
    ///
    /// # Panics
    /// There is no such link.
    pub fn orientation(&self, link: &str) -> Rotation<f64> {
        let frame = self.system.model().frame(link).unwrap_or_else(|| panic!("no link `{link}`"));
        self.w.world.X_WB[frame.body.get()].R * frame.X_BF.R
    }

    /// Angular velocity of a link in the world, rad/s.
    ///
    /// # Panics
    /// There is no such link.
    pub fn angular_velocity(&self, link: &str) -> Vec3<f64> {
        let frame = self.system.model().frame(link).unwrap_or_else(|| panic!("no link `{link}`"));
        let body = frame.body.get();
        self.w.world.X_WB[body].R * self.w.velocity.V_WB[body].w
    }

    /// Kinetic energy, J.
    pub fn kinetic(&self) -> f64 {
        energy::kinetic(self.system.model(), &self.w.velocity)
    }

    /// Potential energy of gravity, J.
    pub fn potential(&self) -> f64 {
        energy::potential(self.system.model(), &self.w.world)
    }
}
