//! A table of the functions of a library.

/// Declares a structure with a field for each function of a library, and its constructor `load`. A function after `optional` may be
/// missing. The declared types must match the library's documentation: they cannot be checked.
macro_rules! functions {
    (
        $(#[$meta:meta])*
        pub struct $table:ident {
            $(fn $name:ident($($argument:ty),* $(,)?) $(-> $result:ty)?;)*
            $(optional fn $option:ident($($option_argument:ty),* $(,)?) $(-> $option_result:ty)?;)*
        }
    ) => {
        $(#[$meta])*
        #[allow(non_snake_case, reason = "the names of the C functions")]
        #[derive(Debug)]
        pub struct $table {
            pub(super) library: $crate::camera::native::library::NativeLibrary,
            $(pub(super) $name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
            $(pub(super) $option: Option<unsafe extern "C" fn($($option_argument),*) $(-> $option_result)?>,)*
        }

        #[allow(non_snake_case, reason = "the names of the C functions")]
        impl $table {
            /// The functions of `library`.
            ///
            /// # Errors
            /// When functions are missing in the library; the error names all of them.
            fn from_library(
                library: $crate::camera::native::library::NativeLibrary,
            ) -> Result<Self, $crate::camera::CameraError> {
                let mut missing: Vec<&str> = Vec::new();
                $(
                    // SAFETY: the type is that of the function in the library's documentation.
                    let $name = unsafe { library.function(stringify!($name)) };
                    if $name.is_none() {
                        missing.push(stringify!($name));
                    }
                )*
                $(
                    // SAFETY: as above.
                    let $option = unsafe { library.function(stringify!($option)) };
                )*
                $(let $name = $name.ok_or_else(|| library.lacks(&missing))?;)*
                Ok(Self { $($name,)* $($option,)* library })
            }
        }
    };
}

pub(in crate::camera) use functions;
