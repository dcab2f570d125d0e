//! The instruction sets that a processor has.

use pulp::Arch;
use thiserror::Error;

/// A name that is not that of an instruction set of this processor.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("instructions is {name:?}; this processor has {}", instructions().join(", "))]
pub struct UnknownInstructions {
    name: String,
}

/// Instruction sets of this processor, the best first.
pub fn instructions() -> Vec<&'static str> {
    known().into_iter().map(|(name, _)| name).collect()
}

/// The instruction set of a name; nothing names the best.
pub fn instructions_named(name: Option<&str>) -> Result<Arch, UnknownInstructions> {
    let Some(wanted) = name else {
        return Ok(Arch::new());
    };
    let known = known();
    match known.iter().find(|(name, _)| *name == wanted) {
        Some((_, arch)) => Ok(*arch),
        None => Err(UnknownInstructions {
            name: wanted.into(),
        }),
    }
}

#[cfg(target_arch = "x86_64")]
fn known() -> Vec<(&'static str, Arch)> {
    use pulp::x86::{V3, V4};
    let avx512 = V4::try_new().map(|simd| ("avx512", Arch::V4(simd)));
    let avx2 = V3::try_new().map(|simd| ("avx2", Arch::V3(simd)));
    let all = [avx512, avx2, Some(("portable", Arch::Scalar))];
    all.into_iter().flatten().collect()
}

#[cfg(not(target_arch = "x86_64"))]
fn known() -> Vec<(&'static str, Arch)> {
    let mut known = vec![("portable", Arch::Scalar)];
    if !matches!(Arch::new(), Arch::Scalar) {
        known.insert(0, (std::env::consts::ARCH, Arch::new()));
    }
    known
}
