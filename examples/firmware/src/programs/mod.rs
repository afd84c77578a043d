//! What the programs in `src/bin` do; `suite` does all of it in one boot.
//!
//! Each answers whether everything was as the host found it, and prints its figures by
//! [`figure`](crate::figure), which `check` compares with `budgets`.

pub mod display;
pub mod flash_query;
pub mod on_device_build;
pub mod stack;
pub mod tof_sensor;
