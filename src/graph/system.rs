//! The track node at work: its statics and its passages, spoken to in the scene's terms.
