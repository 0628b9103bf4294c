//! Things by their names. In files of version 3 a name that is defined once more inside a block has its old meaning behind it.

use std::collections::HashMap;

/// What names stand for.
pub(crate) struct Names<T> {
    known: HashMap<String, T>,
    /// What names stood for before, and where blocks begin in that.
    hidden: Vec<(String, T)>,
    blocks: Vec<usize>,
}

impl<T> Default for Names<T> {
    fn default() -> Self {
        Self { known: HashMap::new(), hidden: Vec::new(), blocks: Vec::new() }
    }
}

impl<T> Names<T> {
    /// Defines a name. What is new inside a block stays known behind it: files rely on that.
    pub(crate) fn define(&mut self, name: String, value: T) {
        if let Some(before) = self.known.insert(name.clone(), value)
            && !self.blocks.is_empty()
        {
            self.hidden.push((name, before));
        }
    }

    pub(crate) fn find(&self, name: &str) -> Option<&T> {
        self.known.get(name)
    }

    /// All names.
    pub(crate) fn all(&self) -> impl Iterator<Item = &str> {
        self.known.keys().map(String::as_str)
    }

    pub(crate) fn begin(&mut self) {
        self.blocks.push(self.hidden.len());
    }

    pub(crate) fn end(&mut self) {
        let begin = self.blocks.pop().unwrap_or_default();
        for (name, value) in self.hidden.drain(begin..).rev() {
            self.known.insert(name, value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_has_its_old_meaning_behind_a_block_and_a_new_one_stays() {
        let mut names = Names::default();
        names.define("a".to_owned(), 1);
        names.begin();
        names.define("a".to_owned(), 2);
        names.define("a".to_owned(), 3);
        names.define("b".to_owned(), 4);
        assert_eq!((names.find("a"), names.find("b")), (Some(&3), Some(&4)));
        names.end();
        assert_eq!((names.find("a"), names.find("b")), (Some(&1), Some(&4)));
    }
}
