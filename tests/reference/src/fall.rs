//! Fall from rest and the response to wind.
