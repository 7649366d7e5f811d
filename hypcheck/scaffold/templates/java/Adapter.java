import java.io.BufferedInputStream;
import java.io.BufferedOutputStream;
import java.io.ByteArrayOutputStream;
import java.io.IOException;
import java.io.InputStream;
import java.io.OutputStream;
import java.nio.ByteBuffer;
import java.nio.ByteOrder;
import java.nio.charset.StandardCharsets;
import java.util.StringTokenizer;

/**
 * The door between hypcheck and Predicate.java: questions on standard input, answers on standard output.
 *
 * <pre>@BUILD@</pre>
 *
 * <p>docs/protocol.md of hypcheck says what is spoken. Nothing here changes when the predicate does.
 */
final class Adapter {
    private static final boolean TILT = Predicate.DESCRIPTION.contains("\"tilt\":true");
@position@
    private static final int COLUMNS = TILT ? 10 : 7;
    private static final String TILTED = TILT ? "tilted-" : "";
@passage@
    private static final boolean TIMES = Predicate.DESCRIPTION.contains("\"times\":true");
    private static final int COLUMNS = TILT ? 13 : 10;
@end@
    private static final int MOST = 65536;
    private static final String NOT_UNDERSTOOD = "the question is not understood";
@position@
    private static final String NO_ROW = TILT ? "a row is not ten decimals" : "a row is not seven decimals";
@passage@
    private static final String NO_ROW = TILT ? "a row is not thirteen decimals" : "a row is not ten decimals";
@end@

    private final InputStream input = new BufferedInputStream(System.in, 1 << 16);
    private final OutputStream output = new BufferedOutputStream(System.out, 1 << 16);

    /** What cannot be answered, and why. */
    private static final class Trouble extends Exception {
        private static final long serialVersionUID = 1;

        Trouble(String why) {
            super(why);
        }
    }

    public static void main(String[] arguments) throws IOException {
        new Adapter().serve();
    }

    private void serve() throws IOException {
        write(Predicate.DESCRIPTION + "\n");
        output.flush();
        for (String line; (line = readLine()) != null; output.flush()) {
            try {
                answer(line.trim().split(" +"));
            } catch (Trouble trouble) {
                write("error " + trouble.getMessage() + "\n");
            }
        }
    }

    /** Reads the rest of a question whose first line has these words, and replies. */
    private void answer(String[] words) throws IOException, Trouble {
        if (words.length < 4) {
            throw new Trouble(NOT_UNDERSTOOD);
        }
        long sequence = number(words[1], 0, Long.MAX_VALUE);
        int n = (int) number(words[2], 0, MOST);
        String form = words[0] + " " + words[words.length - 1];
@position@
        if (words.length == 4 && form.equals("classify " + TILTED + "text")) {
            StringBuilder reply = new StringBuilder(sequence + " " + n + "\n");
            for (byte answer : classify(readText(n))) {
                reply.append(answer).append('\n');
@passage@
        if (words.length == 4 && form.equals("classify passage-text")) {
            StringBuilder reply = new StringBuilder(sequence + " " + n + "\n");
            for (double first : classify(readText(n))) {
                reply.append(hit(first)).append(TIMES && hit(first) == 1 ? " " + first : "").append('\n');
@end@
            }
            write(reply.toString());
@position@
        } else if (words.length == 4 && form.equals("classify " + TILTED + "binary")) {
            byte[] answers = classify(readBinary(n));
            write(sequence + " " + n + "\n");
            output.write(answers);
        } else if (words.length == 5 && form.equals("time " + TILTED + "binary")) {
@passage@
        } else if (words.length == 4 && form.equals("classify passage-binary")) {
            writeBinary(sequence, classify(readBinary(n)));
        } else if (words.length == 5 && form.equals("time passage-binary")) {
@end@
            int repeat = (int) number(words[3], 1, 999_999_999);
            write(sequence + " " + time(readBinary(n), repeat) + "\n");
        } else {
            throw new Trouble(NOT_UNDERSTOOD);
        }
    }

@position@
    private static byte[] classify(double[] rows) {
        byte[] answers = new byte[rows.length / COLUMNS];
        classify(rows, answers);
        return answers;
@passage@
    private void writeBinary(long sequence, double[] times) throws IOException {
        ByteBuffer reply = ByteBuffer.allocate(times.length * (TIMES ? 9 : 1)).order(ByteOrder.LITTLE_ENDIAN);
        for (double first : times) {
            reply.put(hit(first));
        }
        if (TIMES) {
            reply.asDoubleBuffer().put(times);
        }
        write(sequence + " " + times.length + "\n");
        output.write(reply.array());
@end@
    }

@position@
    private static void classify(double[] rows, byte[] answers) {
        for (int i = 0, k = 0; i < answers.length; i++, k += COLUMNS) {
            answers[i] = (byte) (TILT ? tilted(rows, k) : upright(rows, k));
@passage@
    private static byte hit(double first) {
        return (byte) (first >= 0 ? 1 : 0);
    }

    /** The times of first contact, negative where there is none. */
    private static double[] classify(double[] rows) {
        double[] times = new double[rows.length / COLUMNS];
        classify(rows, times);
        return times;
    }

    private static void classify(double[] rows, double[] times) {
        for (int i = 0, k = 0; i < times.length; i++, k += COLUMNS) {
            times[i] = TILT ? tilted(rows, k) : upright(rows, k);
@end@
        }
    }

@position@
    private static int upright(double[] r, int k) {
        return Predicate.predicate(r[k], r[k + 1], r[k + 2], r[k + 3], r[k + 4], r[k + 5], r[k + 6]);
    }

    private static int tilted(double[] r, int k) {
        return Predicate.tilted(
@passage@
    private static double upright(double[] r, int k) {
        return Predicate.predicate(
@end@
                r[k], r[k + 1], r[k + 2], r[k + 3], r[k + 4], r[k + 5], r[k + 6], r[k + 7], r[k + 8], r[k + 9]);
    }

@position@
    private static String time(double[] rows, int repeat) {
        byte[] answers = new byte[rows.length / COLUMNS];
@passage@
    private static double tilted(double[] r, int k) {
        return Predicate.tilted(
                r[k], r[k + 1], r[k + 2], r[k + 3], r[k + 4], r[k + 5], r[k + 6], r[k + 7], r[k + 8], r[k + 9],
                r[k + 10], r[k + 11], r[k + 12]);
    }

    private static String time(double[] rows, int repeat) {
        double[] times = new double[rows.length / COLUMNS];
@end@
        long start = System.nanoTime();
        for (int i = 0; i < repeat; i++) {
@position@
            classify(rows, answers);
@passage@
            classify(rows, times);
@end@
        }
        long took = System.nanoTime() - start;
        long checksum = 0;
@position@
        for (byte answer : answers) {
            checksum += answer;
@passage@
        for (double first : times) {
            checksum += hit(first);
@end@
        }
        return took + " " + checksum;
    }

    private double[] readText(int n) throws IOException, Trouble {
        String[] lines = new String[n];
        for (int i = 0; i < n; i++) { // all of them first, so that the next question is found
            lines[i] = readLine();
        }
        double[] rows = new double[COLUMNS * n];
        for (int i = 0; i < n; i++) {
            parseRow(lines[i], rows, COLUMNS * i);
        }
        return rows;
    }

    private static void parseRow(String line, double[] rows, int at) throws Trouble {
        StringTokenizer words = new StringTokenizer(line == null ? "" : line);
        if (words.countTokens() != COLUMNS) {
            throw new Trouble(NO_ROW);
        }
        for (int column = 0; column < COLUMNS; column++) {
            rows[at + column] = parseNumber(words.nextToken());
        }
    }

    private static double parseNumber(String word) throws Trouble {
        switch (word) {
            case "nan":
                return Double.NaN;
            case "inf":
                return Double.POSITIVE_INFINITY;
            case "-inf":
                return Double.NEGATIVE_INFINITY;
            default:
                try {
                    return Double.parseDouble(word);
                } catch (NumberFormatException error) {
                    throw new Trouble(NO_ROW);
                }
        }
    }

    private double[] readBinary(int n) throws IOException, Trouble {
        byte[] bytes = new byte[8 * COLUMNS * n];
        if (input.readNBytes(bytes, 0, bytes.length) < bytes.length) {
            throw new Trouble("the input ended within the rows");
        }
        double[] rows = new double[COLUMNS * n];
        ByteBuffer.wrap(bytes).order(ByteOrder.LITTLE_ENDIAN).asDoubleBuffer().get(rows);
        return rows;
    }

    /** The next line, null at the end of the input. */
    private String readLine() throws IOException {
        ByteArrayOutputStream line = new ByteArrayOutputStream();
        int next;
        while ((next = input.read()) >= 0 && next != '\n') {
            line.write(next);
        }
        return next < 0 && line.size() == 0 ? null : line.toString(StandardCharsets.ISO_8859_1);
    }

    private void write(String text) throws IOException {
        output.write(text.getBytes(StandardCharsets.UTF_8));
    }

    private static long number(String word, long least, long greatest) throws Trouble {
        try {
            long number = Long.parseLong(word);
            if (number >= least && number <= greatest) {
                return number;
            }
        } catch (NumberFormatException error) {
            // as a number out of range
        }
        throw new Trouble(NOT_UNDERSTOOD);
    }
}
