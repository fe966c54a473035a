//! Tires, suspensions, drivetrain, brakes, aerodynamics, riders: force elements for mbody.
