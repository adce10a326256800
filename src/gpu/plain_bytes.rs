//! Serializes large arrays of plain words as one block of little-endian bytes, for `#[serde(with = "plain_bytes")]`: f32 values
//! keep their bits, and gigabytes are not encoded number by number.

use bytemuck::{Pod, cast_slice, pod_collect_to_vec};
use serde::{
    Deserializer, Serializer,
    de::{Error, Visitor},
};
use std::{fmt, marker::PhantomData};

/// Writes `values`, which consist of words of four bytes.
///
/// # Errors
/// Returns the errors of the serializer.
pub fn serialize<T: Pod, S: Serializer>(
    values: &[T],
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    if cfg!(target_endian = "little") {
        return serializer.serialize_bytes(cast_slice(values));
    }
    let words: &[u32] = cast_slice(values);
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    serializer.serialize_bytes(&bytes)
}

/// Reads what [`serialize`] wrote.
///
/// # Errors
/// Returns the errors of the deserializer, and an error if the bytes are not a whole number of values.
pub fn deserialize<'de, T: Pod, D: Deserializer<'de>>(
    deserializer: D,
) -> std::result::Result<Vec<T>, D::Error> {
    deserializer.deserialize_bytes(Values(PhantomData))
}

struct Values<T>(PhantomData<T>);

impl<T: Pod> Visitor<'_> for Values<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "values of {} bytes", size_of::<T>())
    }

    fn visit_bytes<E: Error>(self, bytes: &[u8]) -> std::result::Result<Vec<T>, E> {
        if !bytes.len().is_multiple_of(size_of::<T>()) {
            return Err(E::invalid_length(bytes.len(), &self));
        }
        if cfg!(target_endian = "little") {
            return Ok(pod_collect_to_vec(bytes));
        }
        let words = bytes.chunks_exact(4);
        let words = words.map(|word| u32::from_le_bytes(std::array::from_fn(|k| word[k])));
        Ok(pod_collect_to_vec(&words.collect::<Vec<u32>>()))
    }
}

#[cfg(test)]
mod tests {
    use serde::{Deserialize, Serialize};

    #[derive(Serialize, Deserialize)]
    struct Field(#[serde(with = "super")] Vec<f32>);

    #[test]
    fn values_keep_their_bits() {
        let field = Field(vec![1.0, -0.0, f32::from_bits(0x7fc0_1234), 1e-42]);
        let bytes = postcard::to_allocvec(&field).unwrap();
        // The length, and four bytes per value.
        assert_eq!(bytes.len(), 17);
        let read: Field = postcard::from_bytes(&bytes).unwrap();
        let bits = |field: &Field| field.0.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read), bits(&field));
        let mut odd = bytes.clone();
        odd[0] -= 1;
        assert!(postcard::from_bytes::<Field>(&odd).is_err());
    }
}
