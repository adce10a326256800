//! What the user wrote, in SI, checked.
