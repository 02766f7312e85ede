use std.textio.all;

-- The text dump of a design: a row for each instant with a change, cells separated by semicolons.
package table is
  procedure start(row : inout line; header : in string);
  procedure put(row : inout line; cell : in string);
end package;

package body table is
  -- Starts a row with the time in picoseconds; the first row follows the header.
  procedure start(row : inout line; header : in string) is
  begin
    if now = 0 fs then
      write(row, "time_ps;" & header);
      writeline(output, row);
    end if;
    write(row, integer'image(now / 1 ps));
  end procedure;

  procedure put(row : inout line; cell : in string) is
  begin
    write(row, ";" & cell);
  end procedure;
end package body;
