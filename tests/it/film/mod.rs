//! Films of a fake renderer whose frames say which one they are.
