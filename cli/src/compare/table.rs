/// Text in columns, each as wide as its widest cell: the first and the last one to the left, the others to the right.
#[derive(Clone, Debug, Default)]
pub struct Table(Vec<Vec<String>>);

impl Table {
    /// A table with this head.
    pub fn new(head: impl IntoIterator<Item = impl Into<String>>) -> Self {
        let mut table = Self::default();
        table.push(head);
        table
    }

    /// Adds a row.
    pub fn push(&mut self, row: impl IntoIterator<Item = impl Into<String>>) {
        self.0.push(row.into_iter().map(Into::into).collect());
    }

    /// The table as lines.
    pub fn render(&self) -> String {
        let columns = self.0.iter().map(Vec::len).max().unwrap_or(0);
        let wide = |cell: &String| cell.chars().count();
        let width = |column: usize| self.0.iter().filter_map(|row| row.get(column)).map(wide).max().unwrap_or(0);
        let widths: Vec<usize> = (0..columns).map(width).collect();
        let mut text = String::new();
        for row in &self.0 {
            let mut line = String::new();
            for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
                line += &match column {
                    0 => format!("{cell:<width$}"),
                    _ if column + 1 == columns => format!("  {cell}"),
                    _ => format!("  {cell:>width$}"),
                };
            }
            text += line.trim_end();
            text.push('\n');
        }
        text
    }
}

/// A number with three digits that count; a dash for none.
pub fn figure(number: f64) -> String {
    match number {
        x if !x.is_finite() => "-".to_owned(),
        x if x >= 99.95 => crate::units::count(x.round() as u64),
        x if x >= 9.995 => format!("{x:.1}"),
        x if x >= 0.9995 => format!("{x:.2}"),
        x if x >= 0.09995 => format!("{x:.3}"),
        x if x >= 0.009995 => format!("{x:.4}"),
        0.0 => "0".to_owned(),
        x => format!("{x:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_stand_below_one_another() {
        let mut table = Table::new(["name", "µs", "remark"]);
        table.push(["a", "10", "none at all"]);
        table.push(["longer", "1", ""]);
        assert_eq!(table.render(), "name    µs  remark\na       10  none at all\nlonger   1\n");
    }

    #[test]
    fn three_digits_count() {
        let texts = [0.0, 0.000_123, 0.0123, 0.123, 1.234, 12.34, 123.4, 12_345.6, f64::NAN].map(figure);
        assert_eq!(texts, ["0", "1.2e-4", "0.0123", "0.123", "1.23", "12.3", "123", "12,346", "-"]);
    }
}
