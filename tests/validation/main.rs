//! Are they the right equations? Published cases, one file each.

#![allow(non_snake_case)]
