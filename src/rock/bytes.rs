//! Numbers in a row of bytes, little-endian.

use crate::{Error, Result};
use glam::{DMat3, DQuat, DVec3};

/// Something that a snapshot holds.
pub(super) trait Plain: Sized {
    fn write(&self, bytes: &mut Vec<u8>);
    fn read(bytes: &mut &[u8]) -> Result<Self>;
}

fn take<const N: usize>(bytes: &mut &[u8]) -> Result<[u8; N]> {
    let Some((head, tail)) = bytes.split_first_chunk::<N>() else {
        return Err(Error::argument(
            "snapshot",
            "it is cut short; use an older one",
        ));
    };
    *bytes = tail;
    Ok(*head)
}

macro_rules! number {
    ($($t:ty),*) => {$(
        impl Plain for $t {
            fn write(&self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
            fn read(bytes: &mut &[u8]) -> Result<Self> {
                take(bytes).map(Self::from_le_bytes)
            }
        }
    )*};
}
number!(f64, u32, i32, u64);

impl Plain for bool {
    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.push(u8::from(*self));
    }
    fn read(bytes: &mut &[u8]) -> Result<Self> {
        take(bytes).map(|[byte]| byte != 0)
    }
}

impl<T: Plain, const N: usize> Plain for [T; N] {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.iter().for_each(|value| value.write(bytes));
    }
    fn read(bytes: &mut &[u8]) -> Result<Self> {
        let values: Vec<T> = (0..N).map(|_| T::read(bytes)).collect::<Result<_>>()?;
        let cut = || Error::argument("snapshot", "it is cut short; use an older one");
        values.try_into().map_err(|_| cut())
    }
}

impl<T: Plain> Plain for Vec<T> {
    fn write(&self, bytes: &mut Vec<u8>) {
        (self.len() as u64).write(bytes);
        self.iter().for_each(|value| value.write(bytes));
    }
    fn read(bytes: &mut &[u8]) -> Result<Self> {
        let count = u64::read(bytes)?;
        // A broken length ends with the bytes, not with the memory: nothing is reserved for it.
        (0..count).map(|_| T::read(bytes)).collect()
    }
}

impl Plain for DVec3 {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.to_array().write(bytes);
    }
    fn read(bytes: &mut &[u8]) -> Result<Self> {
        <[f64; 3]>::read(bytes).map(Self::from_array)
    }
}

impl Plain for DMat3 {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.to_cols_array().write(bytes);
    }
    fn read(bytes: &mut &[u8]) -> Result<Self> {
        <[f64; 9]>::read(bytes).map(|columns| Self::from_cols_array(&columns))
    }
}

impl Plain for DQuat {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.to_array().write(bytes);
    }
    fn read(bytes: &mut &[u8]) -> Result<Self> {
        <[f64; 4]>::read(bytes).map(Self::from_array)
    }
}

/// Field by field, in the order of the list.
macro_rules! fields {
    ($t:ty { $($field:ident),* $(,)? }) => {
        impl crate::rock::bytes::Plain for $t {
            fn write(&self, bytes: &mut Vec<u8>) {
                $(self.$field.write(bytes);)*
            }
            fn read(bytes: &mut &[u8]) -> crate::Result<Self> {
                Ok(Self { $($field: crate::rock::bytes::Plain::read(bytes)?),* })
            }
        }
    };
}
pub(super) use fields;
