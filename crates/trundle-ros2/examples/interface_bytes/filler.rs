//! Fills any structure with distinct values: a source of values for serde instead of bytes.

use serde::de::value::Error;
use serde::de::{DeserializeSeed, Deserializer, Error as _, SeqAccess, Visitor};

/// Gives each value that is asked for another content.
#[derive(Default)]
pub struct Filler {
    /// Number of values that were given.
    given: u8,
}

impl Filler {
    fn next(&mut self) -> u8 {
        self.given = self.given.wrapping_add(1);
        self.given
    }
}

/// Values of a number's type: the bytes of each differ, so that a swapped or a shifted byte is seen.
macro_rules! numbers {
    ($($deserialize:ident $visit:ident $value:expr;)*) => {$(
        fn $deserialize<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
            let value = $value;
            visitor.$visit(value(self.next()))
        }
    )*};
}

/// Structures and arrays: their values, one after the other.
struct Values<'a> {
    filler: &'a mut Filler,
    left: usize,
}

impl<'de> SeqAccess<'de> for Values<'_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        if self.left == 0 {
            return Ok(None);
        }
        self.left -= 1;
        seed.deserialize(&mut *self.filler).map(Some)
    }
}

impl<'de> Deserializer<'de> for &mut Filler {
    type Error = Error;

    numbers! {
        deserialize_bool visit_bool |n| n % 2 == 1;
        // A state of a goal has the values 0 to 6.
        deserialize_i8 visit_i8 |n: u8| (n % 6) as i8 + 1;
        deserialize_u8 visit_u8 |n: u8| n;
        deserialize_i16 visit_i16 |n| 0x0A00 + i16::from(n);
        deserialize_u16 visit_u16 |n| 0xFA00 + u16::from(n);
        deserialize_i32 visit_i32 |n| 0x0A0B_0C00 + i32::from(n);
        deserialize_u32 visit_u32 |n| 0x0A0B_0D00 + u32::from(n);
        deserialize_i64 visit_i64 |n| 0x0A0B_0C0D_0E0F_1000 + i64::from(n);
        deserialize_u64 visit_u64 |n| 0xFA0B_0C0D_0E0F_1100 + u64::from(n);
        deserialize_f32 visit_f32 |n| f32::from(n) + 0.125;
        deserialize_f64 visit_f64 |n| f64::from(n) + 0.1;
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let n = self.next();
        // Lengths of 2 to 5 bytes: all remainders of the alignment.
        visitor.visit_string(format!("\u{e4}{}", "x".repeat(usize::from(n % 4))))
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_string(visitor)
    }

    fn deserialize_byte_buf<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let n = self.next();
        visitor.visit_byte_buf((0..=n % 4).map(|i| n.wrapping_add(i)).collect())
    }

    fn deserialize_bytes<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_byte_buf(visitor)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        // The smallest bound of a sequence in the table is 1; rclpy's own values have longer sequences.
        visitor.visit_seq(Values { filler: self, left: 1 })
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, len: usize, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_seq(Values { filler: self, left: len })
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.deserialize_tuple(fields.len(), visitor)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, Error> {
        Err(Error::custom("a value of a kind that interfaces do not have"))
    }

    fn is_human_readable(&self) -> bool {
        false
    }

    serde::forward_to_deserialize_any! {
        i128 u128 char option unit unit_struct tuple_struct map enum identifier ignored_any
    }
}
