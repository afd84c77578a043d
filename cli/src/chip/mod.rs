//! What a scene will cost on a microcontroller: found on the host by counting nodes and tests of sample rays, and the
//! instructions that each takes on the chip, measured there.

mod choose;
mod costs;
mod prediction;

pub use choose::choose;
pub use costs::{Arithmetic, Costs};
pub use prediction::Prediction;

/// A family of microcontrollers, by what its cores can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Chip {
    /// Cortex-M0 and M0+, no FPU: RP2040, micro:bit, STM32G0
    M0,
    /// Cortex-M3, no FPU: STM32F1
    M3,
    /// Cortex-M4F, with FPU: STM32F4, nRF52
    M4,
    /// Cortex-M7 with FPU: STM32F7, STM32H7, i.MX RT; as many instructions as an M4F, in fewer cycles
    M7,
    /// Cortex-M33 with FPU: RP2350, nRF53, STM32U5
    M33,
    /// RISC-V without FPU and atomics: ESP32-C3
    Rv32imc,
    /// RISC-V without FPU: ESP32-C6, GD32V
    Rv32imac,
    /// RISC-V with FPU
    Rv32imafc,
}

impl Chip {
    /// Its name in the table of costs, which knows no difference between an M4F and an M7.
    const fn measured_as(self) -> &'static str {
        match self {
            Self::M0 => "m0",
            Self::M3 => "m3",
            Self::M4 | Self::M7 => "m4",
            Self::M33 => "m33",
            Self::Rv32imc => "rv32imc",
            Self::Rv32imac => "rv32imac",
            Self::Rv32imafc => "rv32imafc",
        }
    }

    /// Whether floating point is an instruction there, and not a call of many.
    pub const fn has_fpu(self) -> bool {
        matches!(self, Self::M4 | Self::M7 | Self::M33 | Self::Rv32imafc)
    }

    /// Its title with an article.
    pub fn phrase(self) -> String {
        let title = self.title();
        let article = if title.starts_with('R') { "an" } else { "a" };
        format!("{article} {title}")
    }

    /// What it is called.
    const fn title(self) -> &'static str {
        match self {
            Self::M0 => "Cortex-M0",
            Self::M3 => "Cortex-M3",
            Self::M4 => "Cortex-M4F",
            Self::M7 => "Cortex-M7",
            Self::M33 => "Cortex-M33",
            Self::Rv32imc => "RV32IMC",
            Self::Rv32imac => "RV32IMAC",
            Self::Rv32imafc => "RV32IMAFC",
        }
    }
}
